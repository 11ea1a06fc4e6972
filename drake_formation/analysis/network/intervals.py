"""Intervals of a delay, a period or a probability in which something holds: a margin need not be one number."""

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ACCURACY = 1e-12
"""How well an end is narrowed down, relative to itself."""

EXTREME = 1e-6
"""How well a peak or a dip between points is found, relative to their distance."""


class Interval(NamedTuple):
    """Values between two ends, which do not belong to it unless they are the first or the last that there is.

    Attributes:
        low: where it begins.
        high: where it ends; infinity: never.
    """

    low: float
    high: float


def common(one: Iterable[Interval], other: Iterable[Interval]) -> tuple[Interval, ...]:
    """The values that lie in intervals of both, ascending as they are."""
    both = (Interval(max(a.low, b.low), min(a.high, b.high)) for a in one for b in other)
    return tuple(interval for interval in both if interval.low < interval.high)


def where_negative(function: Callable[[float], float], points: Iterable[float]) -> Iterator[Interval]:
    """The intervals in which a function is negative, in turn, as far as some points tell.

    Between points it is looked at where three of them show a peak below zero or a dip above it: neither a narrow
    interval nor a narrow gap between two that shows itself there is stepped over.

    Args:
        function: finite at every point.
        points: ascending; the last one ends the last interval.

    Yields:
        Each interval as soon as its end is found.
    """
    start: float | None = None
    seen: list[tuple[float, float]] = []
    for point in points:
        at = (float(point), function(float(point)))
        if not seen and at[1] < 0:
            start = at[0]
        for left, right in _signs(function, [*seen, at]):
            end = _zero(function, left, right)
            if right[1] < 0:
                start = end
            elif start is not None:
                yield Interval(start, end)
                start = None
        seen = [*seen[-1:], at]
    if start is not None:
        yield Interval(start, seen[-1][0])


def _signs(
    function: Callable[[float], float], seen: list[tuple[float, float]]
) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Neighbours between which the sign changes, among two or three points and what is hidden about the middle one."""
    from scipy.optimize import minimize_scalar

    *before, last = seen
    if not before:
        return []
    if (before[-1][1] < 0) != (last[1] < 0):
        return [(before[-1], last)]
    if len(before) < 2 or (before[0][1] < 0) != (last[1] < 0):
        return []
    sign = -1.0 if last[1] < 0 else 1.0
    if not sign * before[1][1] < sign * before[0][1] or sign * before[1][1] > sign * last[1]:
        return []
    ends = (before[0][0], last[0])
    found = minimize_scalar(
        lambda x: sign * function(float(x)),
        bounds=ends,
        method="bounded",
        options={"xatol": EXTREME * (ends[1] - ends[0])},
    )
    hidden = (float(found.x), sign * float(found.fun))
    return [(before[0], hidden), (hidden, last)] if (hidden[1] < 0) != (last[1] < 0) else []


def _zero(function: Callable[[float], float], left: tuple[float, float], right: tuple[float, float]) -> float:
    from scipy.optimize import brentq

    if 0 in (left[1], right[1]):
        return left[0] if left[1] == 0 else right[0]
    return float(brentq(function, left[0], right[0], xtol=ACCURACY * max(abs(right[0]), ACCURACY), rtol=ACCURACY))
