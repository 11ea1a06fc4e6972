"""Who is linked to whom, drawn: springs grey, channels green, with a dot at the robot that hears if only one does."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from drake_formation.display.markup import html
from drake_formation.display.plane import Plane
from drake_formation.vectors import turned_left
from drake_formation.viz.palette import CHANNEL

Array = NDArray[np.float64]
Pairs = Iterable[tuple[int, int]]

WIDTH, HEIGHT = 260.0, 220.0
"""Of a drawing at the most (px)."""

SPRING = "#b0a08c"
"""Colour of a spring."""

ASIDE = 2.5
"""By how much channels are drawn beside springs (px)."""

FAINT = 60
"""Where there are more lines than this they are faint."""


def graph_svg(robots: int, *, springs: Pairs = (), channels: Pairs = ()) -> str:
    """Links between robots on a circle; see :func:`drawing`."""
    return html(drawing(circle(robots), springs=springs, channels=channels).svg)


def circle(robots: int) -> Array:
    """Places of robots on a circle, the first on top, clockwise; shape (N, 2)."""
    angles = np.pi / 2 - 2 * np.pi * np.arange(robots) / max(robots, 1)
    return np.column_stack([np.cos(angles), np.sin(angles)])


def drawing(places: Array, *, springs: Pairs = (), channels: Pairs = ()) -> Plane:
    """Robots and what links them.

    Args:
        places: of the robots (m), shape (N, 2).
        springs: pairs (i, j) of robots, from 0.
        channels: pairs (i, j) where robot i hears robot j.
    """
    middle, reach = 0.5 * (places.min(axis=0) + places.max(axis=0)), 0.5 * max(np.ptp(places, axis=0).max(), 1e-3)
    extent = np.maximum(np.ptp(places, axis=0) / 2, 0.1 * reach)
    plane = Plane(middle - extent, middle + extent, WIDTH, HEIGHT)
    held, heard = list(springs), set(channels)
    look = {"stroke_width": 1.5, "stroke_opacity": 0.35 if len(held) + len(heard) / 2 > FAINT else 0.9}
    for i, j in held:
        plane.line(places[[i, j]], stroke=SPRING, **look)
    for i, j in sorted(heard):
        both = (j, i) in heard
        if both and i > j:
            continue
        ends = places[[j, i]] + (_aside(places[i] - places[j]) / plane.scale if held else 0.0)
        plane.line(ends, stroke=CHANNEL, stroke_dasharray="4 3", **look)
        if not both:
            plane.dot(ends[1] + 0.2 * (ends[0] - ends[1]), 3.0, fill=CHANNEL)
    size = float(np.clip(90.0 / len(places), 4.0, 9.0))
    for i, place in enumerate(places):
        plane.dot(place, size, fill="white", stroke="#333")
        plane.word(place, str(i + 1), 1.1 * size, fill="#333")
    return plane


def _aside(way: Array) -> Array:
    """A step to the left of a way (px)."""
    length = float(np.hypot(*way))
    return ASIDE * turned_left(way) / length if length else np.zeros(2)
