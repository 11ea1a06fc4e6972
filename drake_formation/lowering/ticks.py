"""Times at regular intervals, counted in whole numbers."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Ticks:
    """The times offset + k period, for whole k from 0.

    A tick is the number that this sum rounds to, and no other: none is missed and none comes twice, wherever a run
    begins, stops and goes on. (Drake's Simulator divides to find the next one, and at period 0.1 and offset 0.03 can
    miss the one at 0.33, depending on where it was told to stop.)

    Attributes:
        offset: the first (s).
        period: what lies between two (s).
    """

    offset: float
    period: float

    def after(self, time: float) -> float:
        """The first tick later than a time (s)."""
        count = self._nearby(time)
        while (tick := self._tick(count)) <= time:
            count += 1
        return tick

    def first(self, time: float) -> int:
        """The number of the first tick that is not before a time."""
        count = self._nearby(time)
        while self._tick(count) < time:
            count += 1
        return count

    def is_one(self, time: float) -> bool:
        """Whether a time is a tick."""
        first = self._nearby(time)
        return any(self._tick(first + k) == time for k in range(4))

    def _nearby(self, time: float) -> int:
        """A number before those of the ticks next to a time."""
        return max(0, math.floor((time - self.offset) / self.period) - 1)

    def _tick(self, count: int) -> float:
        return self.offset + count * self.period
