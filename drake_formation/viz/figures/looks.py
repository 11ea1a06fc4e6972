"""Colour, dashes and marker by which robots, or results laid over each other, are told apart."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import xarray as xr
from matplotlib import colormaps
from matplotlib.colors import to_rgba

Colour = tuple[float, float, float, float]
Dashes = tuple[float, tuple[float, ...]]
"""A line style of Matplotlib's: where it begins, and points on and off."""

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#4B0092", "#6B3A00")
"""Okabe and Ito's (2008) without yellow, which white swallows, and black, which events have; and two dark ones."""
DASHES: tuple[tuple[float, ...], ...] = (
    (),
    (5.0, 1.5),
    (2.0, 1.0),
    (6.0, 1.5, 1.0, 1.5),
    (1.0, 1.0),
    (10.0, 2.0),
    (6.0, 1.5, 1.0, 1.5, 1.0, 1.5),
    (4.0, 1.0, 2.0, 1.0),
)
MARKERS = ("o", "s", "^", "D", "v", "p", "<", "h")


@dataclass(frozen=True)
class Look:
    """How one of several is drawn, in all figures alike.

    Attributes:
        colour: red, green, blue and opacity.
        dashes: of its lines.
        marker: where it is a point.
    """

    colour: Colour
    dashes: Dashes
    marker: str


def look(number: int) -> Look:
    """The look of the first, second … of several, however many there are.

    The first eight differ in everything, so that they are told apart in print without colour too. From the ninth on,
    colours are the same ones, darker and lighter in turn, and dashes go one further each time round.
    """
    again, k = divmod(number - 1, len(COLOURS))
    dashes = (0.0, DASHES[(k + again) % len(DASHES)])
    return Look(_shade(to_rgba(COLOURS[k]), again), dashes, MARKERS[k])


def robot_looks(result: xr.Dataset) -> dict[int, Look]:
    """The look of each robot: that of its number, whichever others there are."""
    return {int(robot): look(int(robot)) for robot in result["robot"].values}


def robot_colours(result: xr.Dataset) -> dict[int, Colour]:
    """A colour for each robot: that of its number, the same in every figure, film and view."""
    return {robot: its.colour for robot, its in robot_looks(result).items()}


def looks_of(names: Iterable[str]) -> dict[str, Look]:
    """The looks of results, laws or whatever else is laid over each other, in their order."""
    return {name: look(number) for number, name in enumerate(names, start=1)}


def spring_looks(names: Sequence[str]) -> dict[str, Look]:
    """Looks of springs, by colours in a row: no robot's, and as many as there are."""
    shades = [0.85 * k / max(len(names) - 1, 1) for k in range(len(names))]
    return {
        name: Look(colormaps["viridis"](shade), look(k + 1).dashes, look(k + 1).marker)
        for k, (name, shade) in enumerate(zip(names, shades, strict=True))
    }


def _shade(colour: Colour, again: int) -> Colour:
    """A colour the n-th time it is needed: towards black and white in turn, and less far each time."""
    towards = 0.0 if again % 2 else 1.0
    share = 0.0 if again == 0 else 0.45 / ((again + 1) // 2)
    red, green, blue = (part + share * (towards - part) for part in colour[:3])
    return red, green, blue, 1.0
