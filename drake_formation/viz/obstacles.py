"""Obstacles in the plane, with their sensing range."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Patch
from matplotlib.patches import Polygon as Outline
from numpy.typing import NDArray

Array = NDArray[np.float64]

OBSTACLE_COLOUR = "0.25"


def draw_obstacles(axes: Axes, result: xr.Dataset, times: list[float]) -> None:
    """Draw a result's obstacles and their sensing range in the plane.

    Args:
        axes: where.
        result: a run.
        times: when those that move are drawn (s), fainter and fainter the longer ago; elsewhen their range is not.
    """
    reach = float(result.attrs["sensing_range_m"])
    if "robot_radius" in result:  # it begins at the footprint
        reach += float(result["robot_radius"].max()) if reach else 0.0
    for k, obstacle in enumerate(result["obstacle"].values):
        own = result.sel(obstacle=obstacle)
        x, y = own["obstacle_position"].values
        radius = float(own["obstacle_radius"])
        places = _places(own, times)
        is_point = places[-1].shape == (1, 2)
        if is_point and len(places) == 1:
            axes.plot([x], [y], "X", color=OBSTACLE_COLOUR, markersize=7, label=None if k else "obstacle")
        for age, vertices in enumerate(reversed(places)):
            shape = grown(vertices, radius, color=OBSTACLE_COLOUR, alpha=0.5 / (1 + age))
            shape.set_label("" if k or age or (is_point and len(places) == 1) else "obstacle")
            axes.add_patch(shape)
        if reach:
            sensed = grown(places[-1], radius + reach, fill=False, linestyle="--", edgecolor="0.5")
            sensed.set_label("" if k else "sensing range")
            axes.add_patch(sensed)


def grown(vertices: Array, radius: float, **style: Any) -> Patch:
    """The patch of all points within a radius (m) of a point, a segment or a polygon (m), shape (vertices, 2)."""
    if len(vertices) == 1:
        return Circle((float(vertices[0, 0]), float(vertices[0, 1])), radius, **style)
    from shapely import LineString, Polygon  # slow to import, and most obstacles are circles

    shape = LineString(vertices) if len(vertices) == 2 else Polygon(vertices)
    thin = 1e-3 * max(shape.length, radius)  # a wall without width is drawn as a line
    return Outline(np.array(shape.buffer(max(radius, thin)).exterior.coords), **style)


def _places(obstacle: xr.Dataset, times: list[float]) -> list[Array]:
    """The vertices of an obstacle (m), where it is at rest once, else at some times."""
    if "obstacle_outline" not in obstacle:
        return [obstacle["obstacle_position"].values[None]]
    outline = obstacle["obstacle_outline"].transpose("time", "vertex", "axis")
    there = outline.values[:, ~np.isnan(outline.values[0, :, 0])]
    if (there == there[0]).all() or not times:
        return [there[0]]
    moments = np.searchsorted(obstacle["time"].values, times)
    return [there[moment] for moment in moments]
