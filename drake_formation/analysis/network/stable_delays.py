"""The delays at which ẋ = A₀ x(t) + A₁ x(t − τ) is stable: intervals, since a longer delay may be the better one."""

from collections.abc import Iterator
from heapq import merge
from itertools import count
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.crossing import ON_AXIS, Crossing, directions
from drake_formation.analysis.network.delay_crossings import all_crossings, stays_on_axis
from drake_formation.analysis.network.intervals import Interval

Array = NDArray[np.float64]

NO_PHASE = 1e-6
"""A phase (rad) this small is zero if without any delay, too, there is a root on the imaginary axis."""


def stable_delays(present: ArrayLike, delayed: ArrayLike, *, up_to: float = np.inf) -> tuple[Interval, ...]:
    """The delays τ at which ẋ = A₀ x(t) + A₁ x(t − τ) is asymptotically stable.

    Roots are counted (Walton and Marshall 1987; Olgac and Sipahi 2002): those in the right half-plane without delay are
    eigenvalues of A₀ + A₁, and every root that meets the imaginary axis as the delay grows does so at one of a few
    phases, periodically and always in the same direction. Where roots go to the right more often than to the left,
    there is a last stable delay.

    Args:
        present: A₀, what acts at once (1/s), shape (n, n).
        delayed: A₁, what acts a delay later (1/s), shape (n, n).
        up_to: longer delays are not looked at (s).

    Returns:
        The intervals (s), ascending, open but for a delay of 0 where it is stable without any. Empty: it is stable at
        no delay.

    Raises:
        IllPosedError: it is stable but for single delays without end; ask up to a finite one.
    """
    now, before = (np.atleast_2d(np.asarray(matrix, dtype=float)) for matrix in (present, delayed))
    return () if stays_on_axis(now, before) else _between(now, before, all_crossings(now, before), up_to)


def _between(present: Array, delayed: Array, crossings: list[Crossing], up_to: float) -> tuple[Interval, ...]:
    """The same, from all crossings of a system none of whose roots stays on the imaginary axis."""
    size = float(np.linalg.norm(present) + np.linalg.norm(delayed))
    at_once = np.linalg.eigvals(present + delayed)
    on_axis = bool((np.abs(at_once.real) <= ON_AXIS * size).any())
    passages = [
        _Passage.through(crossing, *directions(present, delayed, crossing), NO_PHASE if on_axis else 0.0)
        for crossing in crossings
    ]
    right = 2 * sum(each.right for each in passages if each.phase == 0)
    right += int((at_once.real > ON_AXIS * size).sum())
    end, start = min(up_to, _last_return(passages)), 0.0
    if passages and end == np.inf:
        raise IllPosedError("it is stable but for single delays without end; ask for delays up to a finite one")
    found = []
    for delay, change in merge(*(each.times() for each in passages)):
        if delay >= end:
            break
        if right == 0:
            found.append(Interval(start, delay))
        right, start = right + change, delay
    if right == 0:
        found.append(Interval(start, end))
    return tuple(interval for interval in found if interval.low < interval.high)


class _Passage(NamedTuple):
    """Roots ±jω that go right or left through the axis at the delays (θ + 2πk)/ω, with θ in [0, 2π)."""

    phase: float
    frequency: float
    right: int
    left: int

    @classmethod
    def through(cls, crossing: Crossing, right: int, left: int, no_phase: float) -> "_Passage":
        """The roots through the point of a crossing, at which they are without delay if its phase is none."""
        at_once = min(crossing.phase, 2 * np.pi - crossing.phase) <= no_phase
        return cls(0.0 if at_once else crossing.phase, crossing.frequency, right, left)

    def times(self) -> Iterator[tuple[float, int]]:
        """Each delay above 0, and how many more roots are in the right half-plane after it."""
        for k in count(int(self.phase == 0)):
            yield (self.phase + 2 * np.pi * k) / self.frequency, 2 * (self.right - self.left)


def _last_return(passages: list[_Passage]) -> float:
    """A delay (s) after which some root is always in the right half-plane: the bounds of each count add up.

    Infinity where there is none: roots only touch the axis.
    """
    rate = sum((each.right - each.left) * each.frequency for each in passages)
    lead = sum(each.right * each.phase + each.left * (2 * np.pi - each.phase) for each in passages)
    crossing = sum((each.right + each.left) * each.frequency for each in passages)
    return lead / rate if rate > ON_AXIS * crossing else np.inf
