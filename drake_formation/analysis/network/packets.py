"""A linear system some of whose states reach others in packets: what every tick does to it, exactly.

ẋ = A x + Σ_c into_c h_c, where h_c is what was heard last over channel c of what is sent, sent_c x. The state is
lengthened by what is under way and by what is remembered, so that it goes on from tick to tick as a
:class:`~drake_formation.analysis.network.sampled_data.SampledLoop`.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.packet_schedule import PacketChannel, Schedule, schedule
from drake_formation.analysis.network.sampled_data import SampledLoop

Array = NDArray[np.float64]

LARGEST = 800
"""States, with packets under way and what is remembered, up to which ticks are worked out: half a minute."""


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


def packet_ticks(present: Array, channels: Sequence[PacketChannel]) -> list[PacketTick]:
    """What the ticks of a system with packets do, one after the other, until everything begins again.

    Args:
        present: A, shape (n, n).
        channels: at least one, all of which carry as many numbers.

    Raises:
        IllPosedError: they have no common tick, or too much is under way.
    """
    times = schedule(channels)
    layout = _Layout(present, channels, times)
    if layout.size > LARGEST:
        raise IllPosedError(
            f"{layout.size} states, with packets under way and what is remembered, are too many; at most {LARGEST} are "
            "looked at"
        )
    flow = _Flow(present, channels, times.tick)
    shift = layout.shift(flow.alone)
    return [_tick(shift, layout, flow, channels, times, k) for k in range(times.ticks)]


def in_turn(ticks: Sequence[PacketTick]) -> PacketTick:
    """One tick that is stable, in the mean and in mean square, exactly where ticks that take turns are.

    Its state has a place for the state at each of them, from which every tick moves it on to the next place.
    """
    count, size, each = len(ticks), len(ticks[0].loop.base), ticks[0].loop.into.shape[2]
    base, into, out = np.zeros((count * size, count * size)), [], []
    for k, tick in enumerate(ticks):
        here, there = (slice(at * size, (at + 1) * size) for at in (k, (k + 1) % count))
        base[there, here] = tick.loop.base
        for entering, leaving in zip(tick.loop.into[tick.loop.place], tick.loop.out, strict=True):
            into.append(np.zeros((count * size, each)))
            out.append(np.zeros((each, count * size)))
            into[-1][there], out[-1][:, here] = entering, leaving
    shape = (len(into), count * size, each)
    loop = SampledLoop(base, np.reshape(into, shape), np.reshape(out, (shape[0], each, shape[1])), np.arange(len(into)))
    return PacketTick(loop, np.concatenate([tick.arrival for tick in ticks]))


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
        from scipy.linalg import expm

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
