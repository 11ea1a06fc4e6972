"""Pictures are as few as straight lines between them allow."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import load_scenario, simulate
from drake_formation.viz.links import moving_links
from drake_formation.viz.playback import Playback
from drake_formation.viz.view.frames import RATE, REGULAR, TOLERANCE, corners, key_times

SHORT = {"aggregation.duration": 6.0, "transport.duration": 6.0}


@given(
    st.integers(0, 2**32 - 1).map(np.random.default_rng),
    st.integers(2, 60),
    st.integers(1, 3),
    st.floats(1e-3, 1.0),
)
def test_straight_lines_between_corners_are_within_the_tolerance(random, samples, columns, tolerance):
    times = np.cumsum(random.uniform(0.1, 1.0, samples))
    course = np.cumsum(random.normal(size=(samples, columns)), axis=0)
    chosen = corners(times, course, [0, samples - 1], tolerance, samples)
    assert chosen[0] == 0
    assert chosen[-1] == samples - 1
    assert np.all(np.diff(chosen) > 0)
    for column in course.T:
        off = np.interp(times, times[chosen], column[chosen]) - column
        assert np.abs(off).max() <= tolerance * (1 + 1e-9)


def test_what_goes_straight_has_two_pictures():
    times = np.linspace(0, 5, 40)
    assert corners(times, np.outer(times, [1.0, -2.0]), [0, 39], 1e-6, 40).tolist() == [0, 39]


def test_pictures_are_as_near_as_they_say_or_as_few_as_they_may_be():
    playback = Playback(simulate(load_scenario("line", overrides=SHORT), engine="blocks"))
    times = key_times(playback, moving_links(playback), 10_000)
    assert np.array_equal(times * RATE, np.round(times * RATE))
    every = np.linspace(0, playback.end - playback.begin, 3001)
    course = playback.positions(playback.begin + every).reshape(len(every), -1)
    shown = playback.positions(np.minimum(playback.begin + times, playback.end)).reshape(len(times), -1)
    off = [np.abs(np.interp(every, times, y) - x).max() for x, y in zip(course.T, shown.T, strict=True)]
    assert max(off) < 1.5 * TOLERANCE
    regular = np.arange(0.0, playback.end - playback.begin + 0.1, 1 / REGULAR)
    np.testing.assert_array_equal(key_times(playback, [], 2), regular)
    few = key_times(playback, [], len(regular) + 5)
    assert len(few) == len(regular) + 5
    assert set(regular) <= set(few)
