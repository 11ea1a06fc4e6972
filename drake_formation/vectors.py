"""Lengths and turns of vectors in the plane."""

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


def turned_left(vectors: Array) -> Array:
    """Vectors a quarter turn to the left, of the same shape (…, 2)."""
    return np.stack([-vectors[..., 1], vectors[..., 0]], axis=-1)


def least_length(begin: Array, way: Array) -> Array:
    """Least length of a vector on its way from where it begins straight to the way's end, over the last axis."""
    squared = np.maximum(way[..., 0] ** 2 + way[..., 1] ** 2, np.finfo(float).tiny)
    along = begin[..., 0] * way[..., 0] + begin[..., 1] * way[..., 1]
    return length_of(begin + np.clip(-along / squared, 0.0, 1.0)[..., None] * way)


def from_segment(vectors: Array, extent: Array) -> Array:
    """Where vectors end relative to the nearest point of a segment from the origin, over the last axis.

    Args:
        vectors: shape (..., 2).
        extent: the segment's other end, of a shape that goes with the vectors'; where it is the origin too, a point.
    """
    squared = np.maximum(extent[..., 0] ** 2 + extent[..., 1] ** 2, np.finfo(float).tiny)
    along = vectors[..., 0] * extent[..., 0] + vectors[..., 1] * extent[..., 1]
    nearest: Array = vectors - np.clip(along / squared, 0.0, 1.0)[..., None] * extent
    return nearest


def least_from_segment(begin: Array, way: Array, extent: Array) -> Array:
    """Least distance of a vector on its straight way, as for :func:`least_length`, from a segment from the origin."""
    end = begin + way
    ends = np.minimum(length_of(from_segment(begin, extent)), length_of(from_segment(end, extent)))
    corners = np.minimum(least_length(begin, way), least_length(begin - extent, way))
    beside = _cross(extent, begin) * _cross(extent, end), _cross(way, begin) * _cross(way, begin - extent)
    return np.where((beside[0] < 0) & (beside[1] < 0), 0.0, np.minimum(ends, corners))


def _cross(first: Array, second: Array) -> Array:
    crossed: Array = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    return crossed
