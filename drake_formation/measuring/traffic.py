"""What became of the packets of a run, channel by channel."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.parts.roles import TRAFFIC

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Traffic:
    """Packets of the transport phase, for every channel that carries some; arrays of shape (channels,).

    Attributes:
        sent: how many were sent.
        lost: how many were lost.
        delivered: how many arrived and were looked at.
        overtaken: how many a later one overtook.
        late: how many came too late to be used.
        bits: how much was sent (bit).
        mean_age: how old what was known of the speaker was on average (s).
        peak_age: how old it was at worst (s).
        duration: of the phase (s).
    """

    sent: Array
    lost: Array
    delivered: Array
    overtaken: Array
    late: Array
    bits: Array
    mean_age: Array
    peak_age: Array
    duration: float


def traffic(times: Array, recorded: Array, sizes: Array) -> Traffic:
    """What became of packets.

    The age of information is the time since what is known was sent (Kaul, Yates & Gruteser 2012); between two samples
    the packet in use is the one at the later of them, for packets are taken after a sample.

    Args:
        times: of samples (s), rising, at least two, shape (samples,).
        recorded: what the channels told, shape (samples, channels, ``TRAFFIC``).
        sizes: of a packet of each channel (bit), shape (channels,).
    """
    counts = dict(zip(TRAFFIC, np.moveaxis(recorded[-1] - recorded[0], -1, 0), strict=True))
    sent_at = recorded[1:, :, TRAFFIC.index("sent_at")]
    spans, before, after = np.diff(times), times[:-1, None] - sent_at, times[1:, None] - sent_at
    return Traffic(
        **{name: counts[name] for name in TRAFFIC[:5]},
        bits=sizes * counts["sent"],
        mean_age=spans @ (0.5 * (before + after)) / spans.sum(),
        peak_age=after.max(axis=0),
        duration=float(spans.sum()),
    )
