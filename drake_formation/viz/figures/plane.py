"""Where robots went: paths in the plane, with obstacles and the formation along the way."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle

from drake_formation.viz.figures.events import draw_events
from drake_formation.viz.figures.looks import looks_of, robot_looks
from drake_formation.viz.figures.panels import WIDTHS, Width, drawing, height, legend, resize
from drake_formation.viz.figures.results import Results, labelled, transport
from drake_formation.viz.obstacles import draw_obstacles

SNAPSHOTS = 7
"""Formation snapshots drawn along the way, hand-off and end included."""

SPRING_COLOUR = "0.6"

LEFT, BELOW = 14.0, 11.0
"""Room for the labels of axes (mm)."""

GATHERING = (0.0, (1.0, 1.5))
"""Dots of the paths before the hand-off."""


def paths(results: Results, axes: Axes | None = None, *, width: Width = "page") -> Axes:
    """Paths in the plane with obstacles and snapshots of the formation (paper, Figs. 4 and 7).

    Of several results the transports are laid over each other, a colour each, and where the formation is at the end.

    Args:
        results: one result, or several by name.
        axes: where to draw; a figure of their own if not given.
        width: of that figure.
    """
    named = labelled(results)
    title = "paths" if len(named) > 1 else f"{next(iter(named.values())).attrs['title']}: paths"
    with drawing(axes, [height(width)], width, title=title) as (panel,):
        if len(named) == 1:
            (result,) = named.values()
            draw_transport(panel, result)
            _draw_gathering(panel, result)
        else:
            lay_over(panel, named)
        above = legend(panel, above=True)
        if axes is None:
            panel.autoscale_view()
            resize([panel], [plane_height(panel, width) + above], width)
    return panel


def lay_over(axes: Axes, named: dict[str, xr.Dataset]) -> None:
    """Draw the transports of several results, one look each, and the obstacles of the first.

    Their range is drawn where all results have the same.
    """
    first = next(iter(named.values()))
    if len({result.attrs["sensing_range_m"] for result in named.values()}) > 1:
        first = first.assign_attrs(sensing_range_m=0.0)
    for name, its in looks_of(named).items():
        carried = transport(named[name])
        for k, robot in enumerate(carried["robot"].values):
            x, y = carried["position"].sel(robot=robot).values.T
            label = None if k else name
            axes.plot(x, y, color=its.colour, linestyle=its.dashes, alpha=0.85, label=label)
            axes.plot(x[-1:], y[-1:], its.marker, color=its.colour, markeredgecolor="white", markeredgewidth=0.5)
    draw_obstacles(axes, first, snapshot_times(first))
    _finish(axes)


def draw_transport(axes: Axes, result: xr.Dataset) -> None:
    """Draw a transport: paths, obstacles, what happened, and the formation along the way."""
    carried = result.isel(time=result["phase"].values == 1)
    for robot, its in robot_looks(result).items():
        x, y = carried["position"].sel(robot=robot).values.T
        axes.plot(x, y, color=its.colour, label=f"robot {robot}", **_marked(its.marker))
        axes.lines[-1].set_markevery([])  # the legend has the marker of the snapshots
    draw_obstacles(axes, result, snapshot_times(result))
    draw_events(axes, result)
    for time in snapshot_times(result):
        draw_formation(axes, result.sel(time=time))
    _finish(axes)


def draw_formation(axes: Axes, moment: xr.Dataset) -> None:
    """Draw robots, and the springs that hold them, in the plane at one time of a result."""
    acting = moment["spring"].values[moment["acting"].values == 1] if "acting" in moment else moment["spring"].values
    ends = [[int(robot) for robot in str(spring).split("-")] for spring in acting]
    springs = [moment["position"].sel(robot=pair).values for pair in ends]
    axes.add_collection(LineCollection(springs, colors=SPRING_COLOUR, linewidths=0.6, zorder=1))
    for robot, its in robot_looks(moment).items():
        x, y = moment["position"].sel(robot=robot).values
        axes.plot([x], [y], color=its.colour, zorder=3, **_marked(its.marker))
        if "robot_radius" in moment:
            radius = float(moment["robot_radius"].sel(robot=robot))
            axes.add_patch(Circle((x, y), radius, color=its.colour, alpha=0.2, linewidth=0))


def plane_height(axes: Axes, width: Width) -> float:
    """The height (mm) of axes as wide as a figure, with their labels, where both have one scale."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    wide = WIDTHS[width] - LEFT
    return float(np.clip(wide * (top - bottom) / (right - left), 0.15 * wide, 1.2 * wide)) + BELOW


def snapshot_times(result: xr.Dataset) -> list[float]:
    """Times at which the formation has covered equal parts of the transport's path (s), first and last included."""
    carried = result.isel(time=result["phase"].values == 1)
    if carried.sizes["time"] < 2:
        return []
    centre = carried["position"].mean("robot").values
    covered = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(centre, axis=0), axis=-1))])
    marks = np.searchsorted(covered, np.linspace(0.0, covered[-1], SNAPSHOTS))
    return [float(time) for time in carried["time"].values[np.minimum(marks, len(covered) - 1)]]


def _draw_gathering(axes: Axes, result: xr.Dataset) -> None:
    before = result.isel(time=result["phase"].values == 0)
    if not before.sizes["time"]:
        return
    for robot, its in robot_looks(result).items():
        x, y = before["position"].sel(robot=robot).values.T
        axes.plot(x, y, color=its.colour, linewidth=0.8, linestyle=GATHERING)
        axes.plot(x[:1], y[:1], its.marker, color=its.colour, fillstyle="none")
    axes.plot([], [], color="0.4", linewidth=0.8, linestyle=GATHERING, label="aggregation")


def _marked(marker: str) -> dict[str, Any]:
    return {"marker": marker, "markersize": 4.0, "markeredgecolor": "white", "markeredgewidth": 0.5}


def _finish(axes: Axes) -> None:
    axes.set(xlabel="$x$ (m)", ylabel="$y$ (m)", aspect="equal")
    axes.margins(0.02, 0.08)
