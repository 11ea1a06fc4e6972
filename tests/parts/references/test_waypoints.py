import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import generators

from drake_formation.parts.references.minimum_jerk import minimum_jerk, time_share
from drake_formation.parts.references.waypoints import chord_shares, waypoint_trajectory

counts = st.integers(2, 10)
durations = st.floats(0.1, 1000)
few = settings(max_examples=40)


def random_points(rng, count):
    """Points each 0.5 to 5 m from the one before, in any direction."""
    angles, steps = rng.uniform(-np.pi, np.pi, count), rng.uniform(0.5, 5, count)
    return rng.uniform(-10, 10, 2) + np.cumsum(
        np.column_stack([steps * np.cos(angles), steps * np.sin(angles)]), axis=0
    )


def at(trajectory, time, derivative=0):
    return trajectory.EvalDerivative(time, derivative).ravel()


@few
@given(generators, counts, durations)
def test_it_passes_every_point_when_the_minimum_jerk_course_would(rng, count, duration):
    points = random_points(rng, count)
    curve = waypoint_trajectory(points, duration)
    passed = duration * time_share(chord_shares(points))
    np.testing.assert_allclose(curve.get_segment_times(), passed, rtol=1e-12)
    np.testing.assert_allclose([at(curve, time) for time in passed], points, atol=1e-9)


@few
@given(generators, counts, durations)
def test_it_goes_from_rest_to_rest_without_a_jolt(rng, count, duration):
    curve = waypoint_trajectory(random_points(rng, count), duration)
    for time in (0.0, duration):
        for k in (1, 2):
            np.testing.assert_allclose(at(curve, time, k) * duration**k, 0, atol=1e-6)


@few
@given(generators, counts, durations)
def test_it_is_continuous_up_to_the_fourth_derivative(rng, count, duration):
    curve = waypoint_trajectory(random_points(rng, count), duration)
    for piece, (begin, end) in enumerate(
        zip(curve.get_segment_times()[1:-1], curve.get_segment_times()[2:], strict=True)
    ):
        for axis in range(2):
            before, after = (
                np.poly1d(curve.getPolynomial(i, axis, 0).GetCoefficients()[::-1]) for i in (piece, piece + 1)
            )
            elapsed = begin - curve.get_segment_times()[piece]
            for k in range(5):
                left, right = (p.deriv(k)(x) if k else p(x) for p, x in ((before, elapsed), (after, 0.0)))
                scale = duration**k
                np.testing.assert_allclose(left * scale, right * scale, rtol=1e-6, atol=1e-5 * 10**k)
        assert end > begin


@few
@given(generators, counts, durations)
def test_points_on_a_straight_line_change_nothing(rng, count, duration):
    start, goal = rng.uniform(-10, 10, (2, 2))
    shares = np.linspace(0, 1, count) + np.r_[0, rng.uniform(-0.4, 0.4, count - 2) / (count - 1), 0]
    curve = waypoint_trajectory(start + np.outer(shares, goal - start), duration)
    line = minimum_jerk(start, goal, duration)
    for time in np.linspace(0, duration, 17):
        np.testing.assert_allclose(at(curve, time), at(line, time), atol=1e-9)


@few
@given(generators, counts)
def test_slower_is_the_same_curve(rng, count):
    points = random_points(rng, count)
    slow, fast = waypoint_trajectory(points, 60.0), waypoint_trajectory(points, 20.0)
    for share in np.linspace(0, 1, 13):
        np.testing.assert_allclose(at(slow, 60 * share), at(fast, 20 * share), atol=1e-9)
        np.testing.assert_allclose(at(slow, 60 * share, 1) * 3, at(fast, 20 * share, 1), atol=1e-8)


@few
@given(generators, counts)
def test_the_way_back_is_the_same_curve(rng, count):
    points = random_points(rng, count)
    there, back = waypoint_trajectory(points, 10.0), waypoint_trajectory(points[::-1], 10.0)
    for time in np.linspace(0, 10, 13):
        np.testing.assert_allclose(at(there, time), at(back, 10 - time), atol=1e-8)
