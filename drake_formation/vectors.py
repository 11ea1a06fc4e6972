"""Lengths of vectors in the plane."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]


def length(vectors: "xr.DataArray") -> "xr.DataArray":
    """Euclidean length over the axes, units kept."""
    import xarray as xr  # slow to import, and not needed to build a diagram

    lengths: xr.DataArray = xr.apply_ufunc(length_of, vectors, input_core_dims=[["axis"]], keep_attrs=True)
    return lengths


def length_of(vectors: Array) -> Array:
    """Euclidean length over the last axis, x and y."""
    with np.errstate(over="ignore"):  # a run that diverged may end in numbers whose squares overflow
        lengths: Array = np.sqrt(vectors[..., 0] ** 2 + vectors[..., 1] ** 2)
    return lengths


def least_length(begin: Array, way: Array) -> Array:
    """Least length of a vector on its way from where it begins straight to the way's end, over the last axis."""
    squared = np.maximum(way[..., 0] ** 2 + way[..., 1] ** 2, np.finfo(float).tiny)
    along = begin[..., 0] * way[..., 0] + begin[..., 1] * way[..., 1]
    return length_of(begin + np.clip(-along / squared, 0.0, 1.0)[..., None] * way)
