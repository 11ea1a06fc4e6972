"""Formation shapes: the slot h_i of every robot relative to the formation centre."""

import math

import numpy as np
from numpy.typing import NDArray

Slots = NDArray[np.float64]
"""Slots, shape (N, 2), in metres relative to the formation centre."""


def line(robots: int, side: float, heading: float = 90.0) -> Slots:
    """Robots in a row, centred.

    Args:
        robots: number of robots N.
        side: distance between neighbours (m).
        heading: direction from the first robot to the last, from +x counter-clockwise (deg).

    Returns:
        Slots, shape (N, 2).
    """
    along = side * (np.arange(robots) - (robots - 1) / 2)
    return np.outer(along, _direction(heading))


def polygon(robots: int, side: float, heading: float | None = None) -> Slots:
    """Robots on the corners of a regular polygon, counter-clockwise.

    Args:
        robots: number of corners N.
        side: length of a side (m).
        heading: direction of the first robot from the centre, from +x counter-clockwise (deg). By default the
            first robot is the left end of a horizontal top edge.

    Returns:
        Slots, shape (N, 2).
    """
    circumradius = side / (2 * math.sin(math.pi / robots))
    first = 90.0 + 180.0 / robots if heading is None else heading
    return circumradius * np.array([_direction(first + 360.0 * k / robots) for k in range(robots)])


def side_from_width(robots: int, width: float) -> float:
    """Side of a regular polygon (m) from its width across flats (m).

    Raises:
        ValueError: no two sides are parallel (an odd number of corners, or two).
    """
    if robots % 2 or robots < 4:
        raise ValueError(f"a polygon of {robots} corners has no two parallel sides to measure a width across")
    return width * math.tan(math.pi / robots)


def grid(rows: int, columns: int, side: float) -> Slots:
    """Robots on a rectangular grid, row by row from the upper left, centred.

    Args:
        rows: number of rows.
        columns: robots in a row.
        side: distance between neighbours (m).

    Returns:
        Slots, shape (rows * columns, 2).
    """
    x = side * (np.arange(columns) - (columns - 1) / 2)
    y = side * ((rows - 1) / 2 - np.arange(rows))
    return np.array([[column, row] for row in y for column in x])


def _direction(degrees: float) -> Slots:
    """Unit vector; exact along the axes, where cos(90 deg) would leave 6e-17."""
    quarter, rest = divmod(degrees % 360.0, 90.0)
    cos, sin = math.cos(math.radians(rest)), math.sin(math.radians(rest))
    for _ in range(int(quarter)):
        cos, sin = -sin, cos
    return np.array([cos, sin])
