"""Paths whose deviation is drawn larger than it is."""

import numpy as np
import xarray as xr

from drake_formation.paper.figures.paths import SHOWN, exaggerated, exaggeration

CARRIED = xr.Dataset({
    "position": (("time", "robot", "axis"), np.array([[[1.0, 0.0]], [[2.0, 0.05]]])),
    "deviation": (("time", "robot", "axis"), np.array([[[0.0, 0.0]], [[0.0, 0.05]]])),
})  # fmt: skip


def test_the_largest_deviation_is_drawn_as_large_as_said():
    larger = exaggeration(CARRIED)
    drawn = exaggerated(CARRIED, larger)["position"].values
    np.testing.assert_allclose(drawn[1, 0], [2.0, SHOWN])
    np.testing.assert_allclose(drawn[0], CARRIED["position"][0])


def test_what_does_not_deviate_is_drawn_as_it_is():
    still = CARRIED.assign(deviation=0 * CARRIED["deviation"])
    assert exaggeration(still) == 1
    xr.testing.assert_identical(exaggerated(still, 1), still)
