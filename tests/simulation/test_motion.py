import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.simulation.motion import Motion

seeds = st.integers(0, 2**32 - 1)


def random_motion(seed, samples=6, points=3):
    """Any numbers at all at samples of uneven distances."""
    rng = np.random.default_rng(seed)
    times = 3.0 + np.cumsum(rng.uniform(0.01, 1.0, samples))
    return Motion(times, *rng.normal(size=(3, samples, points, 2)))


def along(motion, count=1001):
    """Positions at even shares of every step, shape (steps, count, points, 2)."""
    steps = len(motion.times) - 1
    return motion.at(np.arange(steps), np.tile(np.linspace(0, 1, count), (steps, 1)))[0]


@given(seeds)
def test_a_motion_of_the_fifth_degree_is_followed_exactly(seed):
    rng = np.random.default_rng(seed)
    coefficients = rng.normal(size=(6, 2, 2))
    times = np.sort(rng.uniform(-1, 1, 5))
    parts = [np.polynomial.polynomial.polyval(times, c).transpose(2, 0, 1) for c in derivatives_of(coefficients)]
    asked = rng.uniform(times[0], times[-1], 20)
    found = Motion(times, *parts).at_times(asked)
    for value, c, tolerance in zip(found, derivatives_of(coefficients), (1e-12, 1e-9, 1e-6), strict=True):
        expected = np.polynomial.polynomial.polyval(asked, c).transpose(2, 0, 1)
        np.testing.assert_allclose(value, expected, atol=tolerance * max(1, 1 / np.diff(times).min() ** 2))


def derivatives_of(coefficients):
    first = np.polynomial.polynomial.polyder(coefficients)
    return coefficients, first, np.polynomial.polynomial.polyder(first)


@given(seeds)
def test_samples_are_passed_as_they_are(seed):
    motion = random_motion(seed)
    found = motion.at_times(motion.times)
    for value, expected in zip(found, (motion.position, motion.velocity, motion.acceleration), strict=True):
        np.testing.assert_allclose(value, expected, atol=1e-7)


@given(seeds)
def test_no_point_leaves_a_chord_further_than_it_bulges(seed):
    motion = random_motion(seed)
    begin, end = motion.position[:-1, None], motion.position[1:, None]
    chord = begin + np.linspace(0, 1, 1001)[:, None, None] * (end - begin)
    away = np.linalg.norm(along(motion) - chord, axis=-1).max(axis=1)
    assert (away <= motion.bulge() * (1 + 1e-9)).all()


def test_a_point_in_free_fall_bulges_by_an_eighth():
    times = np.array([0.0, 2.0])
    position = np.array([[[0.0, 0.0]], [[0.0, 2.0]]])
    motion = Motion(times, position, np.array([[[0.0, 0.0]], [[0.0, 2.0]]]), np.array([[[0.0, 1.0]], [[0.0, 1.0]]]))
    assert motion.bulge() == pytest.approx(np.array([[2.0**2 / 8]]))


def test_rounding_over_a_short_step_is_no_speed():
    """Two samples 4e-16 s apart, whose positions differ in the last digit."""
    times = np.array([2.0, 2.0 + 4.5e-16])
    position = np.array([[[10.0, 0.0]], [[np.nextafter(10.0, 11.0), 0.0]]])
    steady = np.array([[[1.0, 0.0]], [[1.0, 0.0]]])
    _, velocity, _ = Motion(times, position, steady, 0 * steady).at(np.array([0]), np.array([[0.25, 0.5]]))
    np.testing.assert_allclose(velocity, [[[[1.0, 0.0]], [[1.0, 0.0]]]], atol=1e-12)


def test_a_single_sample_is_all_there_is():
    motion = Motion(np.array([1.0]), *np.arange(6.0).reshape(3, 1, 1, 2))
    assert motion.bulge().shape == (0, 1)
    np.testing.assert_array_equal(motion.at_times(np.array([1.0]))[1], [[[2.0, 3.0]]])
