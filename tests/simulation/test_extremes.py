import numpy as np
import pytest
from hypothesis import example, given
from simulation.test_motion import along, random_motion, seeds

from drake_formation.simulation.extremes import Vectors, last_beyond, longest, shortest
from drake_formation.simulation.motion import Motion


def places(motion):
    return Vectors.of_positions(motion, motion.bulge())


def lengths(motion):
    """At a thousand places of every step, shape (steps, 1001, points)."""
    return np.linalg.norm(along(motion), axis=-1)


@example(14202)
@given(seeds)
def test_no_vector_is_longer_at_any_time_and_one_is_as_long(seed):
    motion = random_motion(seed)
    expected = lengths(motion).max(axis=(0, 1))
    np.testing.assert_allclose(longest(places(motion), each=True), expected, rtol=1e-5)
    np.testing.assert_allclose(longest(places(motion)), [expected.max()], rtol=1e-5)
    assert (longest(places(motion), each=True) >= expected * (1 - 1e-8)).all()


@given(seeds)
def test_no_vector_is_shorter_at_any_time_and_one_is_as_short(seed):
    motion = random_motion(seed)
    radii = np.array([0.1, 0.2, 0.3])
    least = (lengths(motion) - radii).min()
    (found,) = shortest(places(motion), radii)
    assert least - 2e-2 <= found <= least + 1e-8


@pytest.mark.parametrize("share", [0.0, 0.123456, 0.5, 0.999])
@pytest.mark.parametrize("miss", [0.0, 1e-6, 1e-3])
def test_a_fast_passage_is_found_however_near(share, miss):
    """A step of 0.1 s at 100 m/s past the origin."""
    times = np.array([0.0, 0.1])
    position = np.array([[[-10.0 * share, miss]], [[10.0 * (1 - share), miss]]])
    motion = Motion(times, position, np.full((2, 1, 2), [100.0, 0.0]), np.zeros((2, 1, 2)))
    assert shortest(places(motion))[0] == pytest.approx(miss, abs=1e-8)


@example(13417)
@given(seeds)
def test_the_last_time_beyond_a_bound_is_the_last(seed):
    motion = random_motion(seed, points=2)
    seen = lengths(motion)
    bound = np.quantile(seen, 0.9)
    found = last_beyond(places(motion), bound)
    beyond = np.argwhere((seen > bound).any(axis=2))
    if beyond[-1].tolist() == [len(seen) - 1, 1000]:
        assert found == (len(seen), 0.0)
    else:
        step, cut = beyond[-1]
        assert found is not None
        assert found[0] + found[1] == pytest.approx(step + cut / 1000, abs=1.5e-3)


def test_what_never_is_beyond_a_bound_has_no_last_time():
    motion = random_motion(1)
    assert last_beyond(places(motion), lengths(motion).max() * 1.01) is None


def test_an_excursion_within_a_step_counts():
    """Thrown up and caught again: both samples are at height 0."""
    times = np.array([5.0, 7.0])
    velocity = np.array([[[0.0, 10.0]], [[0.0, -10.0]]])
    motion = Motion(times, np.zeros((2, 1, 2)), velocity, np.full((2, 1, 2), [0.0, -10.0]))
    assert longest(places(motion)) == pytest.approx([5.0])
    step, share = last_beyond(places(motion), 3.2)
    assert (step, share) == (0, pytest.approx(0.8, abs=1e-7))
    assert last_beyond(places(motion), 5.001) is None
