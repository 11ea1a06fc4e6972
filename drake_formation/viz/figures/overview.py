"""A run at a glance: where the robots went, how well they kept the formation, and what they knew of each other."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from numpy.typing import NDArray

from drake_formation.viz.ages import ages
from drake_formation.viz.figures.envelope import draw_band
from drake_formation.viz.figures.histories import draw_quantity
from drake_formation.viz.figures.looks import looks_of
from drake_formation.viz.figures.panels import Width, drawing, height, is_narrow, legend, resize
from drake_formation.viz.figures.plane import draw_transport, lay_over, plane_height
from drake_formation.viz.figures.quantities import CONSENSUS_ERROR
from drake_formation.viz.figures.results import Results, labelled, transport
from drake_formation.viz.figures.scales import scale

Array = NDArray[np.float64]

FRESHEST, OLDEST = 1e-3, 10.0
"""Ages of information (s) between which colours tell apart."""
MARGIN = 0.8
"""About the paths (m)."""
CELLS = 1200
"""Of a picture, from left to right; each shows the oldest of its span, for its pixels are no finer."""
MOST_CHANNELS = 20
"""More channels than this are not named one by one."""


def overview(results: Results, axes: Sequence[Axes] | None = None, *, width: Width = "page") -> list[Axes]:
    """Paths of the transport, consensus errors and, where channels carry packets, how old what is known was.

    Of several results the paths and the largest errors are laid over each other, and the oldest information of any
    channel.

    Args:
        results: one result, or several by name.
        axes: where to draw, two or, where any channels carry packets, three; a figure of their own if not given.
        width: of that figure.
    """
    named = labelled(results)
    told = {name: result for name, result in named.items() if "traffic" in result}
    heights = [height(width, alone=False)] * 2 + (
        [1.2 * height(width, alone=False)] if told else []
    )  # the third has a bar of colours
    title = "" if len(named) > 1 else str(next(iter(named.values())).attrs["title"])
    with drawing(axes, heights, width, title=title) as panels:
        if len(named) == 1:
            (result,) = named.values()
            draw_transport(panels[0], result)
        else:
            lay_over(panels[0], named)
        left, right, bottom, top = _bounds(list(named.values()))
        panels[0].set(xlim=(left, right), ylim=(bottom, top))
        panels[0].set_aspect("equal", adjustable="box")
        above = legend(panels[0], above=True)
        if axes is None:
            resize(panels, [plane_height(panels[0], width) + above, *heights[1:]], width)
        draw_quantity(panels[1], CONSENSUS_ERROR, named)
        if told:
            (_draw_ages if len(named) == 1 else _draw_oldest)(panels[2], told)
            panels[2].set_xlim(panels[1].get_xlim())
            panels[1].set_xlabel("")
            panels[1].tick_params(labelbottom=False)
    return panels


def _bounds(results: Sequence[xr.Dataset]) -> tuple[float, float, float, float]:
    """What the paths' picture shows (m): left, right, bottom, top."""
    found = []
    for result in results:
        found += [transport(result)["position"].values.reshape(-1, 2), result["obstacle_position"].values]
        if "obstacle_outline" in result:
            found.append(result["obstacle_outline"].values.reshape(-1, 2))
    places = np.concatenate(found)
    places = places[np.isfinite(places).all(axis=1)]
    (left, bottom), (right, top) = places.min(axis=0) - MARGIN, places.max(axis=0) + MARGIN
    return float(left), float(right), float(bottom), float(top)


def _draw_ages(axes: Axes, named: dict[str, xr.Dataset]) -> None:
    """How old what is known over every channel is, as colours."""
    (result,) = named.values()
    oldest, edges = _oldest(result)
    names = [str(name).replace("-", " → ") for name in result["channel"].values]
    shown = np.clip(oldest, FRESHEST, OLDEST)
    rows = np.arange(len(names) + 1) - 0.5
    image = axes.pcolormesh(edges, rows, shown, cmap="viridis_r", norm=LogNorm(FRESHEST, OLDEST), rasterized=True)
    few = len(names) <= MOST_CHANNELS
    axes.set_yticks(range(len(names)) if few else [], names if few else [], fontsize="x-small")
    axes.set(xlabel="time $t$ (s)", ylabel="channel" if few else f"{len(names)} channels")
    axes.grid(visible=False)
    axes.invert_yaxis()
    bar: dict[str, Any] = {"location": "bottom", "aspect": 40} if is_narrow(axes) else {"pad": 0.01}
    axes.figure.colorbar(image, ax=axes, label="age of information (s)", **bar)


def _draw_oldest(axes: Axes, named: dict[str, xr.Dataset]) -> None:
    """How old what is known over any channel is, a line for every result."""
    drawn = []
    for name, its in looks_of(named).items():
        oldest, edges = _oldest(named[name])
        drawn.append((edges[:-1], oldest.max(axis=0)))
        draw_band(axes, *drawn[-1], its.colour, its.dashes, name, magnitude=True)
    scale(axes, drawn)
    axes.set(xlabel="time $t$ (s)", ylabel="oldest\ninformation (s)")


def _oldest(result: xr.Dataset) -> tuple[Array, Array]:
    """The largest age within every cell (s), shape (channels, cells), and where the cells begin and end (s)."""
    times = transport(result)["time"].values
    edges = np.linspace(times[0], times[-1], CELLS + 1)
    within = edges[:-1, None] + np.diff(edges)[:, None] * np.linspace(0.05, 0.95, 10)
    found = ages(result, within.ravel())
    oldest: Array = found.reshape(len(found), CELLS, -1).max(axis=-1)
    return oldest, edges
