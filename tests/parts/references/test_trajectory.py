"""The block that plays a trajectory: its motion, its clock, and the same numbers for every scalar type."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue
from pydrake.symbolic import Evaluate, Expression, Variable
from pydrake.trajectories import PiecewisePolynomial

from drake_formation.parts.references.minimum_jerk import minimum_jerk
from drake_formation.parts.references.trajectory import TrajectoryReference, polynomial_motion, trajectory_tables
from drake_formation.parts.references.waypoints import waypoint_trajectory

HAND_OFF, DURATION = 5.0, 10.0
POINTS = np.array([[1.0, 2.0], [4.0, 5.0], [7.0, 1.0], [9.0, 3.0]])
TRAJECTORIES = {
    "minimum jerk": minimum_jerk(POINTS[0], POINTS[-1], DURATION),
    "waypoints": waypoint_trajectory(POINTS, DURATION),
    "cubic": PiecewisePolynomial.CubicWithContinuousSecondDerivatives(
        [0.0, 3.0, 5.0, DURATION], POINTS.T, np.zeros(2), np.zeros(2)
    ),
    "polyline": PiecewisePolynomial.FirstOrderHold([0.0, 3.0, 5.0, DURATION], POINTS.T),
}
times = st.floats(0, 20)
on_the_way = st.floats(HAND_OFF + 1e-3, HAND_OFF + DURATION - 1e-3)
every_trajectory = pytest.mark.parametrize("trajectory", TRAJECTORIES.values(), ids=TRAJECTORIES)
smooth = pytest.mark.parametrize("trajectory", list(TRAJECTORIES.values())[:2], ids=list(TRAJECTORIES)[:2])
few = settings(max_examples=30)


def reference(trajectory):
    return TrajectoryReference(*trajectory_tables(trajectory, HAND_OFF))


def motion(block, time):
    context = block.CreateDefaultContext()
    context.SetTime(time)
    return block.GetOutputPort("centre").Eval(context)


@every_trajectory
@few
@given(time=on_the_way)
def test_it_plays_what_drake_evaluates(trajectory, time):
    expected = [trajectory.EvalDerivative(time - HAND_OFF, k).ravel() for k in range(3)]
    np.testing.assert_allclose(motion(reference(trajectory), time), np.concatenate(expected), atol=1e-9)


@smooth
@few
@given(before=st.floats(0, HAND_OFF), after=st.floats(0, 1e3))
def test_it_rests_at_the_start_before_the_hand_off_and_at_the_goal_afterwards(trajectory, before, after):
    block = reference(trajectory)
    np.testing.assert_allclose(motion(block, before), [*POINTS[0], 0, 0, 0, 0], atol=1e-12)
    np.testing.assert_allclose(motion(block, HAND_OFF + DURATION + after), [*POINTS[-1], 0, 0, 0, 0], atol=1e-12)


@smooth
@few
@given(time=st.floats(HAND_OFF - 1, HAND_OFF + DURATION + 1))
def test_velocity_and_acceleration_are_the_slopes(trajectory, time):
    block, step = reference(trajectory), 1e-5
    slope = (motion(block, time + step) - motion(block, time - step)) / (2 * step)
    np.testing.assert_allclose(slope[:4], motion(block, time)[2:], atol=1e-4)


@smooth
@pytest.mark.parametrize("at", [HAND_OFF, HAND_OFF + DURATION])
def test_nothing_jumps_at_either_end(trajectory, at):
    block = reference(trajectory)
    np.testing.assert_allclose(motion(block, at - 1e-9), motion(block, at + 1e-9), atol=1e-7)


@every_trajectory
@few
@given(time=times)
@example(time=HAND_OFF + 3.0)
def test_automatic_differentiation_gives_the_same_numbers_and_their_slopes(trajectory, time):
    block = reference(trajectory)
    other = block.ToAutoDiffXd()
    context = other.CreateDefaultContext()
    context.SetTime(AutoDiffXd(time, [1.0]))
    outcome = other.GetOutputPort("centre").Eval(context)
    expected = motion(block, time)
    np.testing.assert_array_equal(ExtractValue(outcome).ravel(), expected)
    if HAND_OFF + 1e-6 < time < HAND_OFF + DURATION - 1e-6:
        np.testing.assert_allclose(ExtractGradient(outcome.reshape(-1, 1)).ravel()[:4], expected[2:], atol=1e-9)


@every_trajectory
def test_symbols_give_the_same_numbers_with_time_and_parameters_left_open(trajectory):
    block = reference(trajectory)
    symbolic = block.ToSymbolic()
    context, numbers = symbolic.CreateDefaultContext(), {}
    for k, values in enumerate(trajectory_tables(trajectory, HAND_OFF)):
        symbols = [Variable(f"p{k}_{i}") for i in range(values.size)]
        numbers |= dict(zip(symbols, values.ravel(), strict=True))
        context.get_mutable_numeric_parameter(k).SetFromVector([Expression(symbol) for symbol in symbols])
    t = Variable("t")
    context.SetTime(Expression(t))
    traced = symbolic.GetOutputPort("centre").Eval(context).reshape(-1, 1)
    for time in [4.999, 0.0, *trajectory_tables(trajectory, HAND_OFF)[0], 6.0, 9.3, 14.999, 20.0]:
        expected = motion(block, time)
        np.testing.assert_allclose(Evaluate(traced, numbers | {t: time}).ravel(), expected, rtol=1e-12, atol=1e-12)


def test_a_symbolic_context_with_numbers_gives_the_same_numbers():
    block = reference(TRAJECTORIES["waypoints"])
    for time in (0.0, 5.0, 7.7, 15.0, 16.0):
        outcome = motion(block.ToSymbolic(), Expression(time))
        np.testing.assert_allclose([x.Evaluate() for x in outcome], motion(block, time), rtol=1e-14)


def test_its_output_follows_the_clock_and_its_parameters_and_nothing_else():
    block = reference(TRAJECTORIES["waypoints"])
    assert block.num_input_ports() == 0
    context = block.CreateDefaultContext()
    first = block.GetOutputPort("centre").Eval(context).copy()
    context.SetTime(8.0)
    second = block.GetOutputPort("centre").Eval(context).copy()
    assert (first != second).any()
    context.get_mutable_numeric_parameter(0).SetFromVector(trajectory_tables(TRAJECTORIES["waypoints"], 8.0)[0])
    np.testing.assert_allclose(block.GetOutputPort("centre").Eval(context), first, atol=1e-12)


@given(st.lists(st.floats(-10, 10), min_size=1, max_size=7), st.floats(-3, 3))
def test_horners_rule(coefficients, time):
    polynomial = np.poly1d(coefficients[::-1])
    expected = [polynomial(time), polynomial.deriv()(time), polynomial.deriv(2)(time)]
    np.testing.assert_allclose(polynomial_motion(time, coefficients), expected, rtol=1e-9, atol=1e-9)
