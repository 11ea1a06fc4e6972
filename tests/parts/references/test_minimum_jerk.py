import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import trapezoid

from drake_formation.parts.references.minimum_jerk import minimum_jerk, time_share

places = st.tuples(st.floats(-100, 100), st.floats(-100, 100)).map(np.array)
durations = st.floats(0.1, 1000)
shares = st.floats(0, 1)


def at(trajectory, time, derivative=0):
    return trajectory.EvalDerivative(time, derivative).ravel()


@given(places, places, durations)
def test_it_goes_from_rest_to_rest_without_a_jolt(start, goal, duration):
    line = minimum_jerk(start, goal, duration)
    size = 1 + abs(start).max() + abs(goal).max()
    np.testing.assert_allclose(at(line, 0), start, rtol=0, atol=0)
    np.testing.assert_allclose(at(line, duration), goal, rtol=0, atol=1e-12 * size)
    for time in (0.0, duration):
        for k in (1, 2):
            np.testing.assert_allclose(at(line, time, k), 0, atol=1e-11 * size / duration**k)


@given(places, places, durations, shares)
def test_it_comes_as_it_goes(start, goal, duration, share):
    line = minimum_jerk(start, goal, duration)
    there, back = at(line, share * duration), at(line, (1 - share) * duration)
    np.testing.assert_allclose(there + back, start + goal, atol=1e-9)


@given(places, places, durations, shares)
def test_it_is_fastest_half_way(start, goal, duration, share):
    line, distance = minimum_jerk(start, goal, duration), np.linalg.norm(goal - start)
    peak = np.linalg.norm(at(line, duration / 2, 1))
    assert peak == pytest.approx(1.875 * distance / duration, rel=1e-9, abs=1e-12)
    assert np.linalg.norm(at(line, share * duration, 1)) <= peak * (1 + 1e-12)


@given(places, places, durations, shares)
def test_it_is_a_straight_line(start, goal, duration, share):
    assume(np.linalg.norm(goal - start) > 1e-3)
    way, covered = goal - start, at(minimum_jerk(start, goal, duration), share * duration) - start
    assert abs(way[0] * covered[1] - way[1] * covered[0]) < 1e-9 * (1 + way @ way)
    assert -1e-9 <= covered @ way <= (1 + 1e-9) * (way @ way)


def test_any_other_course_has_more_jerk():
    """Adding to it what keeps position, velocity and acceleration at both ends raises the integral of jerk²."""
    line, u = minimum_jerk([0, 0], [1, 0], 1.0), np.linspace(0, 1, 2001)
    jerk = np.array([at(line, time, 3)[0] for time in u])
    for bump in (np.poly1d([1, -3, 3, -1, 0, 0, 0]), np.poly1d([2, -7, 9, -5, 1, 0, 0, 0])):
        changed = jerk + 0.1 * bump.deriv(3)(u)
        assert trapezoid(changed**2, u) > trapezoid(jerk**2, u)


@given(shares)
def test_the_time_to_a_share_of_the_way_is_when_it_is_covered(share):
    passed = float(time_share(share))
    assert 10 * passed**3 - 15 * passed**4 + 6 * passed**5 == pytest.approx(share, abs=1e-12)
