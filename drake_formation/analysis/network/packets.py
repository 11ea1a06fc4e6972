"""A linear system some of whose states reach others in packets: what every tick does to it, exactly.

ẋ = A x + Σ_c into_c h_c, where h_c is what was heard last over channel c of what is sent, sent_c x. The state is
lengthened by what is under way and by what is remembered, so that it goes on from tick to tick as a
:class:`~drake_formation.analysis.network.sampled_data.SampledLoop`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import pairwise
from math import ceil, gcd, lcm
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.sampled_data import SampledLoop

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


class PacketTick(NamedTuple):
    """One tick.

    Attributes:
        loop: what it does; its channels are those on which a packet may arrive then or may be lost.
        arrival: the probability that it arrives, shape (channels,).
    """

    loop: SampledLoop
    arrival: Array

    @property
    def mean(self) -> Array:
        """The mean of what it does, shape (size, size)."""
        return self.loop.mean(self.arrival)


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


def packet_ticks(present: Array, channels: Sequence[PacketChannel]) -> list[PacketTick]:
    """What the ticks of a system with packets do, one after the other, until everything begins again.

    Args:
        present: A, shape (n, n).
        channels: at least one, all of which carry as many numbers.

    Raises:
        IllPosedError: they have no common tick.
    """
    times = schedule(channels)
    layout, flow = _Layout(present, channels, times), _Flow(present, channels, times.tick)
    shift = layout.shift(flow.alone)
    return [_tick(shift, layout, flow, channels, times, k) for k in range(times.ticks)]


class _Layout:
    """Where things are in the lengthened state: the state itself, what is under way, and what is remembered."""

    def __init__(self, present: Array, channels: Sequence[PacketChannel], times: Schedule) -> None:
        self.states = self.size = len(present)
        self._lines: dict[bytes, tuple[Array, list[slice]]] = {}
        for channel, late in zip(channels, times.late, strict=True):
            _, line = self._lines.setdefault(channel.sent.tobytes(), (channel.sent, []))
            while len(line) < late:
                line.append(self._more(channel.size))
        remembers = (every > 1 or channel.loss > 0 for channel, every in zip(channels, times.every, strict=True))
        self.memories = [
            self._more(channel.size) if needed else None for channel, needed in zip(channels, remembers, strict=True)
        ]

    def _more(self, count: int) -> slice:
        self.size += count
        return slice(self.size - count, self.size)

    def shift(self, alone: Array) -> Array:
        """A tick without what channels do: the state goes on by itself, and what is under way comes nearer."""
        result = np.zeros((self.size, self.size))
        result[: self.states, : self.states] = alone
        for sent, line in self._lines.values():
            for newest in line[:1]:
                result[newest, : self.states] = sent
            for newer, older in pairwise(line):
                result[older, newer] = np.eye(len(sent))
        return result

    def sent(self, channel: PacketChannel, ticks_ago: int) -> Array:
        """What was sent some ticks ago, from the lengthened state, shape (m, size)."""
        result = np.zeros((channel.size, self.size))
        if ticks_ago == 0:
            result[:, : self.states] = channel.sent
        else:
            _, line = self._lines[channel.sent.tobytes()]
            result[:, line[ticks_ago - 1]] = np.eye(channel.size)
        return result

    def at(self, place: slice | None, size: int) -> Array:
        """What is at a place, from the lengthened state; zero at none. Shape (m, size)."""
        result = np.zeros((size, self.size))
        if place is not None:
            result[:, place] = np.eye(size)
        return result


class _Flow:
    """A tick of the continuous part: e^{AT}, and what each channel does by what is heard over it."""

    def __init__(self, present: Array, channels: Sequence[PacketChannel], tick: float) -> None:
        n, sizes = len(present), [channel.size for channel in channels]
        ends = n + np.cumsum([0, *sizes])
        both = np.zeros((ends[-1], ends[-1]))
        both[:n, :n] = present
        for channel, begin, end in zip(channels, ends, ends[1:], strict=False):
            both[:n, begin:end] = channel.into
            if channel.drift is not None:
                both[begin:end, begin:end] = channel.drift
        both = expm(both * tick)
        self.alone: Array = both[:n, :n]
        self.pushed: list[Array] = [both[:n, begin:end] for begin, end in pairwise(ends)]


def _tick(
    shift: Array, layout: _Layout, flow: _Flow, channels: Sequence[PacketChannel], times: Schedule, tick: int
) -> PacketTick:
    base, into, out, arrival = shift.copy(), [], [], []
    for c, channel in enumerate(channels):
        memory = layout.memories[c]
        felt = layout.at(memory, channel.size).T @ channel.goes_on(times.tick)
        felt[: layout.states] = flow.pushed[c]
        before = layout.at(memory, channel.size)
        if (tick - times.first[c]) % times.every[c]:
            base += felt @ before
            continue
        arriving = channel.goes_on(times.tick * times.late[c]) @ layout.sent(channel, times.late[c])
        if channel.loss == 0:
            base += felt @ arriving
            continue
        base += felt @ before
        into.append(felt)
        out.append(arriving - before)
        arrival.append(1 - channel.loss)
    size = channels[0].size
    loop = SampledLoop(
        base,
        np.reshape(into, (len(into), layout.size, size)),
        np.reshape(out, (len(out), size, layout.size)),
        np.arange(len(into)),
    )
    return PacketTick(loop, np.array(arrival))
