import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.autodiffutils import AutoDiffXd
from pydrake.symbolic import Expression, Variable

from drake_formation.parts.avoidance.khatib import TOUCH, ObstacleAvoidance, at_contact, avoidance_force

angles = st.floats(-np.pi, np.pi)
radii = st.just(0.0) | st.floats(0.01, 2)
ranges = st.floats(0.5, 3)
gains = st.floats(0.1, 100)
shares = st.floats(0.1, 0.99)


def potential(dx, dy, radius, sensing_range, gain):
    """Khatib's potential η/2 (1/ρ − 1/ρ0)² within range."""
    clearance = np.hypot(dx, dy) - radius
    return gain / 2 * max(1 / clearance - 1 / sensing_range, 0) ** 2


def away(angle, distance):
    return distance * np.cos(angle), distance * np.sin(angle)


@given(angles, radii, ranges, gains, st.floats(1, 10))
def test_nothing_is_felt_out_of_range(angle, radius, sensing_range, gain, share):
    force = avoidance_force(*away(angle, radius + share * sensing_range * (1 + 1e-9)), radius, sensing_range, gain)
    assert force == (0, 0)


@given(angles, radii, ranges, gains)
def test_the_force_begins_continuously_at_the_range(angle, radius, sensing_range, gain):
    inside = avoidance_force(*away(angle, radius + sensing_range * (1 - 1e-9)), radius, sensing_range, gain)
    assert inside == pytest.approx((0, 0), abs=gain * 1e-8 / sensing_range**3)


@given(angles, radii, ranges, gains, shares)
def test_the_force_points_away_from_the_obstacle(angle, radius, sensing_range, gain, share):
    dx, dy = away(angle, radius + share * sensing_range)
    fx, fy = avoidance_force(dx, dy, radius, sensing_range, gain)
    assert fx * dx + fy * dy > 0
    assert fx * dy - fy * dx == pytest.approx(0, abs=1e-12 * np.hypot(fx, fy) * np.hypot(dx, dy))


@given(angles, radii, ranges, gains, shares)
def test_the_force_is_the_slope_of_khatibs_potential(angle, radius, sensing_range, gain, share):
    dx, dy = away(angle, radius + share * sensing_range)
    field, step = (radius, sensing_range, gain), 1e-5 * share * sensing_range
    slope = (
        (potential(dx + step, dy, *field) - potential(dx - step, dy, *field)) / (2 * step),
        (potential(dx, dy + step, *field) - potential(dx, dy - step, *field)) / (2 * step),
    )
    force = avoidance_force(dx, dy, *field)
    assert force == pytest.approx(tuple(-s for s in slope), rel=1e-4, abs=1e-5 * np.hypot(*force) + 1e-9 * gain)


@given(angles, st.floats(0.01, 2), ranges, gains, shares)
def test_a_round_obstacle_is_felt_as_a_point_at_its_surface(angle, radius, sensing_range, gain, share):
    clearance = share * sensing_range
    round_one = avoidance_force(*away(angle, radius + clearance), radius, sensing_range, gain)
    point = avoidance_force(*away(angle, clearance), 0.0, sensing_range, gain)
    assert round_one == pytest.approx(point, rel=1e-6, abs=1e-9 * np.hypot(*point))


INSIDE = [(0.0, 0.0, 0.0), (0.0, 0.0, 0.3), (0.1, -0.1, 0.3), (0.25, 0.0, 0.25), (1e-9, 0.0, 1.0)]


@pytest.mark.parametrize(("dx", "dy", "radius"), INSIDE[2:])
def test_inside_the_force_is_beyond_all_bounds_in_every_scalar(dx, dy, radius):
    field = (radius, 1.3, 31.56)
    x, y = Variable("x"), Variable("y")
    symbolic = avoidance_force(Expression(x), Expression(y), *field)
    differentiated = avoidance_force(AutoDiffXd(dx, [1.0, 0.0]), AutoDiffXd(dy, [0.0, 1.0]), *field)
    in_arrays = avoidance_force(np.array([dx]), np.array([dy]), *field)
    found = {
        "double": np.hypot(*avoidance_force(dx, dy, *field)),
        "array": np.hypot(*in_arrays)[0],
        "AutoDiff": np.hypot(*(force.value() for force in differentiated)),
        "Expression": np.hypot(*(force.Evaluate({x: dx, y: dy}) for force in symbolic)),
    }
    assert min(found.values()) > 1e140


@pytest.mark.parametrize(("dx", "dy", "radius"), INSIDE[:2])
def test_in_the_very_middle_the_force_has_no_direction(dx, dy, radius):
    assert avoidance_force(dx, dy, radius, 1.3, 31.56) == (0.0, 0.0)


@pytest.mark.parametrize(("dx", "dy", "radius"), INSIDE)
def test_without_a_gain_there_is_no_force_inside_either(dx, dy, radius):
    assert avoidance_force(dx, dy, radius, 1.3, 0.0) == (0.0, 0.0)
    moved = avoidance_force(AutoDiffXd(dx, [1.0]), AutoDiffXd(dy, [0.0]), radius, 1.3, 0.0)
    assert [(force.value(), force.derivatives().tolist()) for force in moved] == [(0.0, [0.0])] * 2


def test_the_law_takes_arrays():
    dx, dy = np.array([0.5, 2.0]), np.array([0.5, 2.0])
    fx, fy = avoidance_force(dx, dy, 0.0, 1.3, 31.56)
    assert (fx[0], fy[0]) == pytest.approx(avoidance_force(0.5, 0.5, 0.0, 1.3, 31.56))
    assert (fx[1], fy[1]) == (0, 0)


OBSTACLES = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.2]]


def force(phase=1.0, sensed=None, at=(0.0, 0.1)):
    block = ObstacleAvoidance([1.3, 31.56], OBSTACLES, masked=sensed is not None)
    context = block.CreateDefaultContext()
    block.GetInputPort("state").FixValue(context, [*at, 5.0, 5.0])
    block.GetInputPort("phase").FixValue(context, [phase])
    if sensed is not None:
        block.GetInputPort("sensed").FixValue(context, sensed)
    return block.GetOutputPort("force").Eval(context).tolist()


def single(obstacle):
    x, y, radius = OBSTACLES[obstacle]
    return np.array(avoidance_force(0.0 - x, 0.1 - y, radius, 1.3, 31.56))


def test_the_forces_of_all_obstacles_add():
    assert force() == pytest.approx(single(0) + single(1))


def test_no_obstacle_is_felt_during_aggregation():
    assert force(phase=0.0) == [0, 0]


@pytest.mark.parametrize("at", [(1.0, 0.0), (0.0, 1.0), (0.1, 0.9)])
def test_inside_an_obstacle_that_is_not_felt_there_is_no_force(at):
    assert force(phase=0.0, at=at) == [0, 0]
    assert force(sensed=[0.0, 0.0], at=at) == [0, 0]
    assert at in ((1.0, 0.0), (0.0, 1.0)) or np.hypot(*force(at=at)) > 1e140


@pytest.mark.parametrize("sensed", [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
def test_only_sensed_obstacles_are_felt(sensed):
    assert force(sensed=sensed) == pytest.approx(sensed[0] * single(0) + sensed[1] * single(1))


@given(angles, radii, st.floats(0.05, 1), ranges, gains, shares)
def test_a_footprint_is_felt_as_a_larger_obstacle_until_it_all_but_touches(
    angle, radius, footprint, sensing_range, gain, share
):
    dx, dy = away(angle, radius + footprint + TOUCH * footprint + share * sensing_range)
    felt = avoidance_force(*at_contact(dx, dy, radius, footprint), sensing_range, gain)
    assert felt == pytest.approx(avoidance_force(dx, dy, radius + footprint, sensing_range, gain), rel=1e-9)


@given(angles, radii, st.floats(0.05, 1), ranges, gains, shares)
def test_a_footprint_that_touches_is_pushed_away_by_a_finite_force(
    angle, radius, footprint, sensing_range, gain, share
):
    nearest = TOUCH * footprint
    expected = gain * max(1 / nearest - 1 / sensing_range, 0) / nearest**2
    for distance in (radius + footprint, radius + share * footprint, share * footprint):
        dx, dy = away(angle, distance)
        fx, fy = avoidance_force(*at_contact(dx, dy, radius, footprint), sensing_range, gain)
        assert np.hypot(fx, fy) == pytest.approx(expected, rel=1e-6)
        assert fx * dx + fy * dy > 0
