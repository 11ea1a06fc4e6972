"""Helpers of the paper's figures."""

import numpy as np
import xarray as xr

from drake_formation.paper.figures.curves import farthest
from drake_formation.paper.figures.schematics import spring_shape


def test_the_error_shown_is_that_of_the_robot_farthest_off():
    error = xr.Dataset({"consensus_error": (("time", "robot", "axis"), [[[3.0, 0.0], [0.0, 4.0]]])})
    assert farthest(error).item() == 4.0


def test_a_drawn_spring_joins_its_ends():
    ends = np.array([[0.0, 1.0], [2.0, 5.0]])
    shape = spring_shape(ends)
    np.testing.assert_allclose(shape[[0, -1]], ends)
