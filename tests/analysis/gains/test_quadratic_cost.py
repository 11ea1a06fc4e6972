"""Error and effort after a random hand-off: simulation, formulas, and gradients through the diagram."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator_
from strategies import scenarios

from drake_formation import load_scenario, simulate
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.quadratic_cost import HandOffCost
from drake_formation.analysis.linear.control_gains import AutoDiffFormation, control_gains
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.scenario import resolve, with_overrides


def test_two_robots_have_a_formula():
    """m s̈ + D ṡ + K s = 0 from rest at 1: ∫s² = D/2K + m/2D, ∫u² = K² m/2D, for the relative and the common mode."""
    formation = linearize(load_scenario("line", overrides={"springs.stiffness": 0.0}))
    error, effort = HandOffCost(formation, 1.0).error_and_effort(30.0, 5.0)
    stiffness, damping, mass = 1 + 2 * 30, 9 + 2 * 5, 40
    assert error == pytest.approx((damping / (2 * stiffness) + mass / (2 * damping)) / 2)
    assert effort == pytest.approx((stiffness**2 * mass / (2 * damping) + mass / (2 * 9)) / 2)


@given(scenario=scenarios(robots=st.integers(2, 4)), weight=st.floats(1e-8, 1e-2))
@settings(max_examples=15, deadline=None)
def test_the_gradient_is_that_of_finite_differences(scenario, weight):
    costs = HandOffCost(linearize(scenario), 1.0)
    gains = np.array([300.0, 30.0])
    _, gradient = costs.cost(gains, weight)
    steps = np.diag(1e-4 * gains)
    differences = [
        (costs.cost(gains + step, weight)[0] - costs.cost(gains - step, weight)[0]) / (2 * step.sum()) for step in steps
    ]
    np.testing.assert_allclose(gradient * gains, differences * gains, atol=1e-5 * costs.cost(gains, weight)[0])


@given(scenario=scenarios(robots=st.integers(2, 4)))
@settings(max_examples=10, deadline=None)
def test_derivatives_by_the_gains_hold_for_all_gains(scenario):
    formation = linearize(scenario)
    forces = control_gains(formation)
    sensitivities = HandOffCost(formation).sensitivities
    np.testing.assert_allclose(sensitivities[0], forces.per_delta, atol=1e-9)
    np.testing.assert_allclose(sensitivities[1], forces.per_delta_v, atol=1e-9)


@pytest.mark.parametrize("stiffness", [0.0, 300.0])
def test_the_gradient_is_that_of_a_simulated_diagram(stiffness):
    """Drake's Simulator in AutoDiffXd carries ∂/∂δ and ∂/∂δ_v along a trajectory; errors are small, springs linear."""
    changes = {"springs.stiffness": stiffness, "consensus.delta": 40.0, "consensus.delta_v": 30.0}
    formation = linearize(load_scenario("line", overrides=changes))
    weight, gains, end, step = 1e-3, np.array([40.0, 30.0]), 20.0, 0.02
    displaced = np.zeros(8)
    displaced[[0, 1, 4, 5]] = 1e-5 * np.array([1.0, 0.5, -1.0, -0.5])

    diagram = AutoDiffFormation(formation)
    diagram.set_gains(InitializeAutoDiff(gains).ravel())
    diagram.set_deviation(displaced)
    simulator = Simulator_[AutoDiffXd](diagram.diagram, diagram.context)
    ResetIntegratorFromFlags(simulator, "runge_kutta3", step)
    simulator.get_mutable_integrator().set_fixed_step_mode(True)

    def running_cost():
        state = simulator.get_context().get_continuous_state_vector().CopyToVector() - diagram.rest
        error = (state[:2] - state[4:6]) / 2
        forces = diagram.forces()
        return (2 * (error @ error) + weight * (forces @ forces)) / 2

    samples = []
    for k in range(int(end / step) + 1):
        simulator.AdvanceTo(k * step)
        samples.append(running_cost())
    weights = step * np.ones(len(samples))
    weights[[0, -1]] /= 2
    value = weights @ ExtractValue(np.array(samples)).ravel()
    gradient = weights @ ExtractGradient(np.array(samples))

    # The same by the adjoint equation, for this one hand-off instead of the mean of all.
    costs = HandOffCost(formation)
    costs.__dict__["hand_off_covariance"] = np.outer(displaced, displaced)
    expected, by_adjoint = costs.cost(gains, weight)
    assert value == pytest.approx(expected, rel=2e-3)
    np.testing.assert_allclose(gradient * gains, by_adjoint * gains, atol=1e-3 * value)
    assert np.all(np.abs(by_adjoint * gains) > 0.05 * value)


def test_the_mean_of_simulated_hand_offs():
    """Unit errors of each robot and axis in turn are a random hand-off's mean: their costs add up."""
    formation = linearize(load_scenario("line", overrides={"springs.stiffness": 100.0, "consensus.delta": 50.0}))
    size = 1e-3
    error, effort = HandOffCost(formation, size).error_and_effort(50.0, 20.0)
    errors, efforts = [], []
    for robot, axis in np.ndindex(2, 2):
        displaced = np.zeros((2, 2))
        displaced[robot, axis] = size / np.sqrt(2)
        start = resolve(formation.scenario).slots + np.array(formation.scenario.transport.goal) + displaced
        changes = {"robots.start": start.tolist(), "consensus.delta_v": 20.0, "simulator.accuracy": 1e-9}
        result = simulate(with_overrides(formation.scenario, changes), engine="compiled")
        errors.append(np.trapezoid((result.consensus_error**2).sum("axis").mean("robot"), result.time))
        efforts.append(np.trapezoid((result.control_force**2).sum("axis").mean("robot"), result.time))
    assert sum(errors) == pytest.approx(error, rel=5e-3)
    assert sum(efforts) == pytest.approx(effort, rel=5e-3)


def test_errors_and_efforts_scale_with_the_hand_off():
    formation = linearize(load_scenario("quadrilateral"))
    small, large = (np.array(HandOffCost(formation, size).error_and_effort(9.0, 4.0)) for size in (0.01, 0.1))
    np.testing.assert_allclose(large, 100 * small)


def test_an_unstable_loop_has_no_cost():
    formation = linearize(load_scenario("line"))
    with pytest.raises(IllPosedError, match="unstable"):
        HandOffCost(formation).error_and_effort(-1e4, 0.0)
