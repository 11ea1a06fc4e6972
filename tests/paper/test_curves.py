"""Helpers of the paper's figures."""

import numpy as np
import xarray as xr

from drake_formation.paper.curves import envelope, whole_error
from drake_formation.paper.schematics import spring_shape


def test_the_envelope_is_the_largest_value_of_each_window():
    time = np.linspace(100.0, 110.0, 4001)
    ringing = xr.Dataset(coords={"time": time}).assign(x=("time", np.abs(np.sin(40 * time)) * np.exp(-(time - 100))))
    middles, largest = envelope(ringing, ringing["x"], width=0.5)
    np.testing.assert_allclose(largest[:-1], np.exp(-(middles[:-1] - 0.25)), rtol=0.1)
    assert largest.max() == ringing["x"].max()


def test_the_whole_error_is_the_norm_over_robots_and_axes():
    error = xr.Dataset({"consensus_error": (("time", "robot", "axis"), [[[3.0, 0.0], [0.0, 4.0]]])})
    assert whole_error(error).item() == 5.0


def test_a_drawn_spring_joins_its_ends():
    ends = np.array([[0.0, 1.0], [2.0, 5.0]])
    shape = spring_shape(ends)
    np.testing.assert_allclose(shape[[0, -1]], ends)
