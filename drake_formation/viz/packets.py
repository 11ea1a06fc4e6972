"""Packets of a run as its record tells them: from whom to whom, when sent, and when taken or lost.

A result has, sample by sample, how many packets each channel has lost, and when the one in use was sent. So every
packet that came into use between two samples is known by both its times, but for those that a newer one pushed out
between the same two; and of lost packets how many there are between two samples.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.parts.roles import TRAFFIC
from drake_formation.viz.playback import Playback

Array = NDArray[np.float64]

OLD = 1.0
"""A channel over which nothing younger is known is taken for dead (s)."""

SEEN = 0.1
"""How long a lost packet is shown, for it is lost in no time (s)."""

HALF_WAY = 0.5
"""Where on its channel a lost packet is shown; where it was lost nobody knows."""

ROUNDING = 1e-9
"""Of times (s)."""


@dataclass(frozen=True, eq=False)
class Packets:
    """Packets in order of their channels; arrays of shape (packets,).

    Attributes:
        channel: on which channel of the formation, from 0.
        start: when it was sent, or lost (s).
        end: when the robot that hears took it, or how long it is shown as lost (s).
        lost: whether it was lost.
        out_of: how many were sent.
    """

    channel: NDArray[np.intp]
    start: Array
    end: Array
    lost: NDArray[np.bool_]
    out_of: int

    def __len__(self) -> int:
        return len(self.channel)

    def some(self, chosen: NDArray[np.bool_] | slice) -> "Packets":
        """Some of them, out of as many."""
        return Packets(self.channel[chosen], self.start[chosen], self.end[chosen], self.lost[chosen], self.out_of)

    def under_way(self, time: float) -> NDArray[np.bool_]:
        """Which are to be seen at a time (s)."""
        result: NDArray[np.bool_] = (self.start <= time) & (time < self.end)
        return result

    @property
    def at_once(self) -> int:
        """How many are under way at once at the most."""
        changes = np.concatenate([np.ones(len(self)), -np.ones(len(self))])
        order = np.lexsort([changes, np.concatenate([self.start, self.end])])  # who arrives makes room first
        return int(np.cumsum(changes[order]).max(initial=0))

    def places(self, playback: Playback, time: Array) -> Array:
        """Where each is at a time of its own (m), shape (packets, 2), on a straight way between its robots.

        Args:
            playback: of the run.
            time: when (s), shape (packets,).
        """
        way = np.clip((time - self.start) / np.maximum(self.end - self.start, ROUNDING), 0.0, 1.0)
        share = np.where(self.lost, HALF_WAY, way)[:, None]
        listener, speaker = playback.formation.channels.pairs[self.channel].T
        each = np.arange(len(self))
        begins = playback.positions(np.where(self.lost, time, self.start))[each, speaker]
        ends = playback.positions(np.where(self.lost, time, self.end))[each, listener]
        result: Array = begins + share * (ends - begins)
        return result


def packets_of(playback: Playback) -> Packets:
    """The packets that a run's record tells; none where no channel carries any."""
    times, recorded, channels = playback.traffic
    counts = dict(zip(TRAFFIC, np.moveaxis(recorded, -1, 0), strict=True))
    found = [np.zeros((0, 4))]
    for column, channel in enumerate(channels):
        sent_at, lost = counts["sent_at"][:, column], np.diff(counts["lost"][:, column])
        taken = np.flatnonzero(np.diff(sent_at) > 0)
        looked = _last_look(playback, channel, times)
        starts = sent_at[taken + 1]
        found.append(_rows(channel, starts, np.maximum(looked[taken + 1], starts), lost=False))
        gone = np.repeat(looked[1:], np.rint(lost).astype(int))
        found.append(_rows(channel, gone, gone + SEEN, lost=True))
    channel, start, end, lost = np.concatenate(found).T
    out_of = int((counts["sent"][-1] - counts["sent"][0]).sum())
    return Packets(channel.astype(np.intp), start, end, lost == 1.0, out_of)


def heard(playback: Playback, times: Array) -> NDArray[np.bool_]:
    """Whether each channel tells its robot something that is heeded and not old, shape (m, channels).

    Between two samples the packet in use is the one at the later of them, for packets are taken after a sample.
    """
    formation = playback.formation
    result = np.ones((len(times), len(formation.channels.pairs)), dtype=bool)
    samples, recorded, channels = playback.traffic
    later = np.minimum(np.searchsorted(samples, times), len(samples) - 1)
    for column, channel in enumerate(channels):
        sent_at = recorded[:, column, TRAFFIC.index("sent_at")]
        result[:, channel] = times - sent_at[later] <= OLD
        timeout = getattr(formation.parts["channel"][channel].config, "timeout", None)
        if timeout is not None:
            new = np.diff(sent_at, prepend=-np.inf) > 0
            taken = np.maximum.accumulate(np.where(new, _last_look(playback, channel, samples), samples[0]))
            result[:, channel] &= times - taken[later] <= timeout + ROUNDING
    for k, (i, j) in enumerate(formation.channels.pairs.tolist()):
        if (heeded := formation.signals.get(f"heard_{i + 1}_{j + 1}")) is not None:
            result[:, k] &= heeded[playback.stage(times), 0] == 1
    return result


def thinned(packets: Packets, most: int, at_once: int) -> Packets:
    """Every so manieth packet of each channel, used or lost, so that there are not too many.

    Args:
        packets: all.
        most: how many there may be.
        at_once: how many there may be under way at once.
    """
    step = max(1, -(-len(packets) // most))
    while (chosen := packets.some(slice(step // 2, None, step))).at_once > at_once:
        step += max(1, step // 4)
    return chosen


def _rows(channel: int, start: Array, end: Array, *, lost: bool) -> Array:
    return np.column_stack([np.full(len(start), channel), start, end, np.full(len(start), lost)])


def _last_look(playback: Playback, channel: int, times: Array) -> Array:
    """When the receiver of a channel looked last before each of some samples (s), for they show what was before."""
    ticks = playback.formation.parts["channel"][channel].ticks()
    looked = [phase + period * np.ceil((times - phase) / period - 1.0 - ROUNDING) for period, phase in ticks]
    latest: Array = np.max(looked, axis=0) if looked else times
    result: Array = np.maximum(latest, times[0])
    return result
