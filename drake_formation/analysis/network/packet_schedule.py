"""Channels of packets as plain data, and the ticks at which what they carry is sent and looked for."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from math import ceil, gcd, lcm
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError

Array = NDArray[np.float64]

MOST_TICKS = 200
"""Ticks until all channels send together again, up to which their periods are taken to have a common one."""

ON_TIME = 1e-9
"""A packet that is late by this share of the time between two looks is not late."""


@dataclass(frozen=True)
class PacketChannel:
    """One directed channel.

    Attributes:
        into: what is heard does this to the derivative (1/s), shape (n, m).
        sent: what of the state is sent, shape (m, n).
        period: between packets (s).
        delay: of every packet (s); it takes effect when the receiver looks next.
        looks: how many times a period the receiver looks for what has arrived.
        phase: when the first packet is sent (s).
        loss: probability that a packet is lost, independently of all others.
        drift: G, by which what was heard is taken to go on until a newer packet comes, ḣ = G h; zero where it is held.
            Shape (m, m).
    """

    into: Array
    sent: Array
    period: float
    delay: float = 0.0
    looks: int = 1
    phase: float = 0.0
    loss: float = 0.0
    drift: Array | None = None

    @property
    def size(self) -> int:
        """How many numbers a packet carries, m."""
        return len(self.sent)

    def goes_on(self, seconds: float) -> Array:
        """What was heard, so much later, shape (m, m)."""
        from scipy.linalg import expm

        result: Array = np.eye(self.size) if self.drift is None else expm(self.drift * seconds)
        return result


class Schedule(NamedTuple):
    """When packets arrive, in ticks.

    Attributes:
        tick: the time between two of them (s).
        ticks: after how many everything begins again.
        every: ticks between the packets of each channel.
        late: ticks that each channel's are under way.
        first: the tick at which each channel's first one arrives, but for whole periods.
    """

    tick: float
    ticks: int
    every: tuple[int, ...]
    late: tuple[int, ...]
    first: tuple[int, ...]


def schedule(channels: Sequence[PacketChannel]) -> Schedule:
    """The ticks of some channels; times count as the decimals that they are written as.

    Raises:
        IllPosedError: they have no common tick, or only one that is very short beside their periods.
    """
    periods = [Fraction(repr(float(channel.period))) for channel in channels]
    looks = [period / channel.looks for period, channel in zip(periods, channels, strict=True)]
    phases = [Fraction(repr(float(channel.phase))) for channel in channels]
    phases = [phase - min(phases) for phase in phases]
    lateness = [
        max(0, ceil(channel.delay / float(look) - ON_TIME)) * look
        for channel, look in zip(channels, looks, strict=True)
    ]
    whole = reduce(lcm, (time.denominator for time in [*looks, *phases]))
    count = reduce(gcd, (int(time * whole) for time in [*looks, *phases]))
    tick = Fraction(count, whole)
    every = tuple(int(period / tick) for period in periods)
    if reduce(lcm, every) > MOST_TICKS:
        named = ", ".join(f"{value:g}" for value in sorted({channel.period for channel in channels}))
        raise IllPosedError(f"packets that are sent every {named} s have no common tick, or too short a one")
    late = tuple(int(time / tick) for time in lateness)
    first = tuple(int(phase / tick) + ticks for phase, ticks in zip(phases, late, strict=True))
    return Schedule(float(tick), reduce(lcm, every), every, late, first)
