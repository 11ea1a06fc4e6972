"""Whether a formation is stable over the channels that its scenario has: the channel certificate.

A robot feels its own state continuously; only what its neighbours say passes through channels. At rest that is
ẋ = A x + Σ_c into_c h_c with the neighbours' terms of the consensus law apart, of which
:mod:`drake_formation.analysis.network.channel_verdict` judges.
"""

from collections.abc import Sequence
from math import ceil
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.block_diagonal import blocks, distinct
from drake_formation.analysis.linear.linearization import STATES, LinearFormation, own
from drake_formation.analysis.network.channel_verdict import UNKNOWN, ChannelVerdict, delay_verdict, packet_verdict
from drake_formation.analysis.network.packet_schedule import ON_TIME, PacketChannel
from drake_formation.parts.channels.delay import Delay
from drake_formation.parts.channels.packets import Packets

Array = NDArray[np.float64]


def moves_on(places: int) -> Array:
    """ḣ = G h of a neighbour that is taken to go on at the velocity heard last, of so many places and their rates."""
    return np.eye(2 * places, k=places)


def channel_certificate(formation: LinearFormation) -> ChannelVerdict | None:
    """Whether the formation is stable over its scenario's channels.

    Args:
        formation: the linearized formation, whose matrices are for wires.

    Returns:
        The verdict; None where all channels are wires, for which the modes say it.
    """
    parts = formation.channels
    if all(_is_wire(part) for part in parts):
        return None
    if formation.medium.kind != "none":
        return ChannelVerdict(UNKNOWN, "channels share a medium, which makes some packets wait and loses others")
    for part in parts:
        reason = None if _is_wire(part) else _not_linear(part, formation)
        if reason is not None:
            return ChannelVerdict(UNKNOWN, reason)
    if len({type(part) for part in parts if not _is_wire(part)}) > 1:
        return ChannelVerdict(UNKNOWN, "some channels carry packets and others are pure delays")
    consensus = formation.consensus(formation.delta, formation.delta_v)
    present, heard = formation.tracking + formation.springs + own(consensus), consensus - own(consensus)
    first = parts[0]
    if not _may_lose(first) and all(part.config == first.config for part in parts):
        pieces = distinct(blocks([present, heard], formation.resolved.masses))
        return _worst([_alike(first, *piece) for piece in pieces])
    return _each(formation, present, heard)


def _is_wire(part: Any) -> bool:
    return bool(getattr(part, "is_wire", False))


def _may_lose(part: Any) -> bool:
    return isinstance(part, Packets) and not part.is_wire and part.network.loss > 0


def _not_linear(part: Any, formation: LinearFormation) -> str | None:
    """Why nothing can be said about channels of a kind; None where something can."""
    if isinstance(part, Delay):
        return None
    if not isinstance(part, Packets):
        return f"nothing is known about channels of kind {part.kind!r}"
    config, network = part.config, part.network
    slots = formation.resolved.slots
    reach = np.linalg.norm(slots[:, None] - slots, axis=-1).max()
    shortest, longest = _delays(part)
    look = network.period / config.looks
    reasons = {
        "packets are sent when a robot has moved far enough, not at given times": config.trigger > 0,
        "delays differ from packet to packet": _looks(shortest, look) != _looks(longest, look),
        "packets are lost in bursts": network.loss > 0 and network.burst > 1,
        "packets are lost as measured": any(config.losses),
        "every packet is lost": network.loss == 1,
        "what is sent is rounded, so that small deviations do not die out": config.quantum > 0,
        "the clocks of the robots drift apart": config.clock_drift != 0,
        "a clock that is ahead makes packets look older or newer than they are": config.clock_offset != 0
        and (config.missing == "predict" or config.order == "buffer"),
        "packets arrive later than they are to be used": config.order == "buffer" and longest > config.playout,
        "links are down at times": bool(config.outages) or config.failure_rate > 0,
        "some robots are out of each other's reach": 0 < config.range <= reach,
        "a robot that hears nothing new leaves its own term out too": config.missing == "zero"
        and (network.loss > 0 or config.looks > 1),
        "a neighbour that is not heard is dropped": config.timeout is not None
        and (network.loss > 0 or config.timeout < network.period),
    }
    return next((reason for reason, holds in reasons.items() if holds), None)


def _delays(part: Packets) -> tuple[float, float]:
    """The shortest and the longest delay of a packet (s)."""
    config, network = part.config, part.network
    if config.delays:
        return min(config.delays), max(config.delays)
    if config.distribution == "gamma" and network.spread > 0:
        return 0.0, np.inf
    spread = network.spread if config.distribution == "uniform" else 0.0
    return network.delay - spread, network.delay + spread


def _looks(delay: float, look: float) -> float:
    """How many times the receiver looks until a packet is there."""
    return max(0, ceil(delay / look - ON_TIME)) if np.isfinite(delay) else np.inf


def _packets(part: Packets, into: Array, sent: Array, drift: Array | None) -> PacketChannel:
    config, network = part.config, part.network
    delay = config.playout if config.order == "buffer" else _delays(part)[1]
    goes_on = drift if config.missing == "predict" else None
    return PacketChannel(into, sent, network.period, delay, config.looks, config.phase, network.loss, goes_on)


def _alike(part: Any, present: Array, heard: Array) -> ChannelVerdict:
    """Of a block of a formation all of whose channels are the same: positions, then their rates."""
    if isinstance(part, Delay):
        return delay_verdict(present, [(heard, part.config.delay)])
    size = len(present)
    return packet_verdict(present, [_packets(part, heard, np.eye(size), moves_on(size // 2))])


def _each(formation: LinearFormation, present: Array, heard: Array) -> ChannelVerdict:
    """Of the whole formation, channel by channel."""
    packets, delayed = [], []
    for part, (listener, speaker) in zip(formation.channels, formation.resolved.channels.pairs.tolist(), strict=True):
        rows, columns = (slice(STATES * robot, STATES * (robot + 1)) for robot in (listener, speaker))
        into, sent = np.zeros((len(present), STATES)), np.eye(len(present))[columns]
        into[rows] = heard[rows, columns]
        if _is_wire(part):
            present = present + into @ sent
        elif isinstance(part, Delay):
            delayed.append((into @ sent, float(part.config.delay)))
        elif isinstance(part, Packets):
            packets.append(_packets(part, into, sent, moves_on(2)))
    return packet_verdict(present, packets) if packets else delay_verdict(present, delayed)


def _worst(verdicts: Sequence[ChannelVerdict]) -> ChannelVerdict:
    """Of parts that do not act on each other: unstable if one is, certified if all are."""
    order = ("unstable", UNKNOWN, "stable")

    def rank(verdict: ChannelVerdict) -> tuple[int, float]:
        growth = verdict.growth_1_per_s
        return order.index(verdict.label), np.inf if growth is None else -growth

    return min(verdicts, key=rank)
