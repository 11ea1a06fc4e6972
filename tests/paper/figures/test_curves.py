"""Helpers of the paper's figures."""

import numpy as np
import xarray as xr

from drake_formation.paper.figures.curves import PIXELS, draw_band, farthest, windows
from drake_formation.paper.figures.schematics import spring_shape


def test_windows_have_the_extremes_of_a_ringing():
    time = np.linspace(0.0, 10.0, 4001)
    middles, lowest, highest = windows(time, np.sin(40 * time) * np.exp(-time), 0.5)
    np.testing.assert_allclose(highest[:-1], np.exp(-(middles[:-1] - 0.25)), rtol=0.15)
    np.testing.assert_allclose(lowest[:-1], -np.exp(-(middles[:-1] - 0.25)), rtol=0.15)


def test_a_slow_signal_is_a_line_and_a_fast_one_a_band():
    from matplotlib.figure import Figure

    time = xr.DataArray(np.linspace(0.0, 60.0, 60001))
    for signal, thick in ((np.cos(time), False), (np.cos(300 * time), True)):
        axes = Figure().subplots()
        draw_band(axes, time, signal, "black", "-", "")
        (band,) = axes.collections
        (polygon,) = band.get_paths()
        inside = (polygon.vertices[:, 0] > 1) & (polygon.vertices[:, 0] < 59)
        heights = np.abs(polygon.vertices[inside, 1])
        assert (heights.min() > 0.9) == thick
        assert len(axes.lines[0].get_xdata()) <= PIXELS + 1


def test_the_error_shown_is_that_of_the_robot_farthest_off():
    error = xr.Dataset({"consensus_error": (("time", "robot", "axis"), [[[3.0, 0.0], [0.0, 4.0]]])})
    assert farthest(error).item() == 4.0


def test_a_drawn_spring_joins_its_ends():
    ends = np.array([[0.0, 1.0], [2.0, 5.0]])
    shape = spring_shape(ends)
    np.testing.assert_allclose(shape[[0, -1]], ends)
