"""What happened in a run, marked in its figures where and when it did."""

from itertools import cycle

import xarray as xr
from matplotlib.axes import Axes

from drake_formation.simulation.events import HAND_OFF, Event, events

MARKERS = ("*", "P", "D", "v", "^", "h", "<", ">")
"""One for each kind, in order of what happened first."""
COLOUR = "black"
"""No robot has it."""
MOST_TIMES = 3
"""A legend tells as many times of one kind; of more it counts them."""


def draw_events(axes: Axes, result: xr.Dataset) -> None:
    """Mark what happened in the plane, a marker and a line of the legend for each kind.

    The hand-off has none: paths are drawn otherwise from there on.
    """
    for (kind, its), marker in zip(_by_kind(result).items(), cycle(MARKERS), strict=False):
        x, y = zip(*(event.place for event in its), strict=True)
        label = f"{kind.replace('_', ' ')}, {_when(its)}"
        (marks,) = axes.plot(x, y, marker, color=COLOUR, markersize=6, label=label, zorder=5)
        marks.set(markeredgecolor="white", markeredgewidth=0.7)


def mark_events(axes: Axes, result: xr.Dataset) -> None:
    """Mark when things happened, other than the hand-off, in a figure over time."""
    for its in _by_kind(result).values():
        for event in its:
            axes.axvline(event.time, color=COLOUR, linewidth=0.7, linestyle=":", zorder=0)


def _by_kind(result: xr.Dataset) -> dict[str, list[Event]]:
    kinds: dict[str, list[Event]] = {}
    for event in events(result):
        if event.kind != HAND_OFF:
            kinds.setdefault(event.kind, []).append(event)
    return kinds


def _when(its: list[Event]) -> str:
    if len(its) > MOST_TIMES:
        return f"{len(its)} times"
    return ", ".join(f"{event.time:.4g}" for event in its) + " s"
