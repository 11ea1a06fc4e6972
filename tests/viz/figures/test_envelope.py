"""A signal is drawn as it is where it is slow, and between its extremes where it is faster than a pixel."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.figure import Figure

from drake_formation.viz.figures.envelope import COLUMNS, SAMPLES, draw_band, envelope, windows

TIME = np.linspace(0.0, 60.0, 60001)


def test_windows_have_the_extremes_of_a_ringing():
    time = np.linspace(0.0, 10.0, 4001)
    middles, lowest, highest = windows(time, np.sin(40 * time) * np.exp(-time), 0.5)
    assert len(middles) == 20
    np.testing.assert_allclose(highest, np.exp(-(middles - 0.25)), rtol=0.15)
    np.testing.assert_allclose(lowest, -np.exp(-(middles - 0.25)), rtol=0.15)


def test_a_slow_signal_is_a_line_of_few_of_its_samples():
    times, low, high = envelope(TIME, np.cos(TIME))
    np.testing.assert_array_equal(low, high)
    np.testing.assert_array_equal(high, np.cos(times))
    assert len(times) <= COLUMNS * SAMPLES


def test_a_pulse_within_a_ringing_keeps_its_height_and_its_time():
    pulse = 5.0 * np.exp(-((TIME - 30.0) ** 2))
    times, low, high = envelope(TIME, pulse + 0.1 * np.cos(300 * TIME))
    steepest = 5.0 * np.sqrt(2 / np.e)
    column = 60.0 / COLUMNS
    np.testing.assert_allclose(high, 5.0 * np.exp(-((times - 30.0) ** 2)) + 0.1, atol=1.6 * column * steepest)
    assert high.max() < 5.2
    assert abs(times[high.argmax()] - 30.0) < 0.5
    assert (high - low).min() > 0.15


@settings(max_examples=20)
@given(rate=st.floats(0.1, 600.0), decay=st.floats(0.0, 0.1), seed=st.integers(0, 99))
def test_the_extremes_of_a_signal_are_those_of_its_band(rate, decay, seed):
    time = np.sort(np.random.default_rng(seed).uniform(0.0, 60.0, COLUMNS * SAMPLES // 2))
    values = np.cos(rate * time) * np.exp(-decay * time)
    times, low, high = envelope(time, values)
    assert (low <= high).all()
    assert (np.diff(times) >= 0).all()
    # Of a slow column a few samples are drawn, so that an extreme of it may be missed, by little.
    np.testing.assert_allclose([low.min(), high.max()], [values.min(), values.max()], atol=0.05)


def test_a_magnitude_is_followed_along_its_upper_edge_and_another_along_both():
    for magnitude, lines in ((True, 1), (False, 2)):
        axes = Figure().subplots()
        draw_band(axes, TIME, 2 + np.cos(300 * TIME), "black", "-", "", magnitude=magnitude)
        assert len(axes.lines) == lines
        np.testing.assert_allclose(axes.lines[0].get_ydata(), 3.0, atol=0.05)
        assert len(axes.collections) == 1


def test_what_is_not_known_is_left_out():
    times, low, high = envelope([0.0, 1.0, 2.0], [np.nan, 1.0, np.inf])
    assert (times.tolist(), low.tolist(), high.tolist()) == ([1.0], [1.0], [1.0])
    assert len(envelope([], [])[0]) == 0
