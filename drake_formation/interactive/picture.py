"""A picture of a run, of which only what changes is drawn anew: its lines, and all if they leave their axes."""

import io
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from PIL import Image

from drake_formation.scenario import resolve
from drake_formation.simulation.result import labelled_result
from drake_formation.simulation.series import Series
from drake_formation.vectors import length_of
from drake_formation.viz.figures import robot_colours
from drake_formation.viz.obstacles import draw_obstacles
from drake_formation.viz.style import own_style

Array = NDArray[np.float64]
Limits = tuple[float, float]

SIZE, DPI = (10.0, 3.2), 90
"""Of the picture (inches), and its pixels an inch."""

LEAST = 1e-6
"""The least consensus error that is shown (m)."""

ROOM, FACTOR = 0.1, 2.0
"""Beside lines that leave their axes, as a share of what all take, or on a logarithmic axis as a factor."""


class Picture:
    """The paths of a run on the left, and its consensus errors on the right.

    Args:
        first: the run that all others are compared with: its lines stay, in grey.
    """

    def __init__(self, first: Series) -> None:
        formation, result = resolve(first.scenario), labelled_result(first)
        colours = robot_colours(result).values()
        with own_style():
            self._figure = Figure(figsize=SIZE, dpi=DPI, layout="constrained")
            self._canvas: Any = FigureCanvasAgg(self._figure)
            self._plane, self._errors = self._figure.subplots(1, 2, width_ratios=[3, 2])
            self._plane.set(aspect="equal", xlabel="x (m)", ylabel="y (m)")
            self._errors.set(yscale="log", xlabel="time (s)", ylabel="consensus error (m)")
            draw_obstacles(self._plane, result, [])
            for place, colour in zip(formation.goal + formation.slots, colours, strict=True):
                self._plane.plot(*place, "x", color=colour)
            grey: dict[str, Any] = {"color": "0.75", "linewidth": 1.0, "zorder": 0}
            moving: dict[str, Any] = {"animated": True, "linewidth": 1.2}
            self._lines = []
            for axes, lines in zip((self._plane, self._errors), _lines(first), strict=True):
                axes.grid(alpha=0.3)
                for x, y in lines:
                    axes.plot(x, y, **grey)
                self._lines.append([axes.plot([], [], color=colour, **moving)[0] for colour in colours])
            self._figure.draw_without_rendering()
            self._figure.set_layout_engine("none")  # once for all pictures
        self._background: Any = None

    def drawn(self, series: Series) -> bytes:
        """The picture of a run as PNG."""
        with own_style(), rc_context({"path.simplify_threshold": 1.0}):  # to a pixel, which is faster by a half
            fit = [
                _shown(axes, lines, values)
                for axes, lines, values in zip((self._plane, self._errors), self._lines, _lines(series), strict=True)
            ]
            if self._background is None or not all(fit):
                self._canvas.draw()  # all but the lines, which are animated
                self._background = self._canvas.copy_from_bbox(self._figure.bbox)
            self._canvas.restore_region(self._background)
            for axes, lines in zip((self._plane, self._errors), self._lines, strict=True):
                for line in lines:
                    axes.draw_artist(line)
        png = io.BytesIO()
        Image.fromarray(np.asarray(self._canvas.buffer_rgba())).save(png, "png", compress_level=1)
        return png.getvalue()


def _lines(series: Series) -> tuple[list[Array], list[Array]]:
    """Of every robot its path (m), and its consensus error (m) over time (s), each of shape (2, samples)."""
    error = np.maximum(length_of(series["consensus_error"]), LEAST)
    robots = range(error.shape[1])
    return [series["position"][:, i].T for i in robots], [np.stack([series["time"], error[:, i]]) for i in robots]


def _shown(axes: Axes, lines: list[Line2D], values: list[Array]) -> bool:
    """Give lines their values; whether the axes hold them as they are. If not, they are made to."""
    for line, value in zip(lines, values, strict=True):
        line.set_data(*value)
    across, up = np.concatenate(values, axis=1)
    before = axes.get_xlim(), axes.get_ylim()
    after = _grown(before[0], across), _grown(before[1], up, logarithmic=axes.get_yscale() == "log")
    axes.set(xlim=after[0], ylim=after[1])
    return before == after


def _grown(limits: Limits, values: Array, *, logarithmic: bool = False) -> Limits:
    """Limits that hold all values, with room on a side where they did not; else as they are."""
    low, high = float(values.min()), float(values.max())
    if logarithmic:
        below, above = low / FACTOR, high * FACTOR
    else:
        room = ROOM * (max(high, limits[1]) - min(low, limits[0]))
        below, above = low - room, high + room
    return (limits[0] if limits[0] <= low else below), (limits[1] if high <= limits[1] else above)
