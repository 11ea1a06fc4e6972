"""A run at a glance: where the robots went, how well they kept the formation, and what they knew of each other."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drake_formation.vectors import length
from drake_formation.viz.events import draw_events
from drake_formation.viz.figures import (
    draw_formation,
    draw_history,
    mark_transport,
    robot_colours,
    snapshot_times,
)
from drake_formation.viz.obstacles import draw_obstacles

Array = NDArray[np.float64]

FRESHEST, OLDEST = 1e-3, 10.0
"""Ages of information (s) between which colours tell apart."""
WIDTH = 10.0
"""Of the picture (in)."""
MARGIN = 0.8
"""About the paths (m)."""
CELLS = 1200
"""Of a picture, from left to right; each shows the oldest of its span, for its pixels are no finer."""


def overview(result: xr.Dataset) -> Figure:
    """Paths of the transport, consensus errors and, where channels carry packets, how old what is known was."""
    packets = "traffic" in result
    heights = [_paths_height(result), *[2.4] * (1 + packets)]
    figure = Figure(figsize=(WIDTH, sum(heights) + 1.6), layout="constrained")
    rows = figure.subplots(len(heights), height_ratios=heights)
    _draw_paths(rows[0], result)
    _draw_error(rows[1], result)
    if packets:
        _draw_ages(figure, rows[2], result)
        rows[1].sharex(rows[2])
        rows[1].tick_params(labelbottom=False)
        rows[1].set_xlabel("")
    figure.suptitle(str(result.attrs["title"]))
    return figure


def _bounds(result: xr.Dataset) -> tuple[float, float, float, float]:
    """What the paths' picture shows (m): left, right, bottom, top."""
    places = result["position"].where(result["phase"] == 1).values.reshape(-1, 2)
    outlines = result["obstacle_outline"].values.reshape(-1, 2) if "obstacle_outline" in result else np.zeros((0, 2))
    places = np.concatenate([places, result["obstacle_position"].values, outlines])
    places = places[np.isfinite(places).all(axis=1)]
    (left, bottom), (right, top) = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
    return float(left), float(right), float(bottom), float(top)


def _paths_height(result: xr.Dataset) -> float:
    left, right, bottom, top = _bounds(result)
    return min(max(0.9 * WIDTH * (top - bottom) / (right - left), 1.5), WIDTH)


def _draw_paths(axes: Axes, result: xr.Dataset) -> None:
    carried = result.isel(time=result["phase"].values == 1)
    for robot, colour in robot_colours(result).items():
        x, y = carried["position"].sel(robot=robot).values.T
        axes.plot(x, y, color=colour, linewidth=1.2, label=f"robot {robot}")
    draw_obstacles(axes, result, snapshot_times(result))
    draw_events(axes, result)
    for time in snapshot_times(result):
        draw_formation(axes, result.sel(time=time))
    left, right, bottom, top = _bounds(result)
    axes.set(xlabel="x (m)", ylabel="y (m)", xlim=(left, right), ylim=(bottom, top))
    axes.set_aspect("equal", adjustable="box")
    axes.grid(alpha=0.3)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=7, fontsize="small", frameon=False)


def _draw_error(axes: Axes, result: xr.Dataset) -> None:
    error = length(result["consensus_error"]) * 100
    draw_history(axes, result, error)
    largest = float(error.where(result["phase"] == 1).max())
    axes.set(xlabel="time (s)", ylabel="consensus error (cm)", ylim=(0.0, 1.1 * largest if largest > 0 else 1.0))
    mark_transport(axes, result, only=True)


def ages(result: xr.Dataset, times: Array) -> Array:
    """How old what is known over each channel is (s), shape (channels, times)."""
    known = result["traffic"].sel(count="sent_at").values
    later = np.minimum(np.searchsorted(result["time"].values, times), len(known) - 1)
    found: Array = (times[:, None] - known[later]).T
    return found


def _draw_ages(figure: Figure, axes: Axes, result: xr.Dataset) -> None:
    carried = result["time"].values[result["phase"].values == 1]
    edges = np.linspace(carried[0], carried[-1], CELLS + 1)
    within = edges[:-1, None] + np.diff(edges)[:, None] * np.linspace(0.05, 0.95, 10)
    names = [str(name).replace("-", " → ") for name in result["channel"].values]
    oldest = ages(result, within.ravel()).reshape(len(names), CELLS, -1).max(axis=-1)
    shown = np.clip(oldest, FRESHEST, OLDEST)
    rows = np.arange(len(names) + 1) - 0.5
    image = axes.pcolormesh(edges, rows, shown, cmap="viridis_r", norm=LogNorm(FRESHEST, OLDEST), rasterized=True)
    few = len(names) <= 20
    axes.set_yticks(range(len(names)) if few else [], names if few else [], fontsize="x-small")
    axes.set(xlabel="time (s)", ylabel="channel" if few else f"{len(names)} channels")
    axes.invert_yaxis()
    figure.colorbar(image, ax=axes, label="age of information (s)", pad=0.01)
