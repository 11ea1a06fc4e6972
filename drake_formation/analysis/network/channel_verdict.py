"""Whether a linear system stays stable over given channels: certified, refuted, or neither, and why.

Constant delays make a system of packets a periodic discrete one, and pure delays a delay-differential equation; both
have a spectrum that decides. Where packets are lost independently the mean square decides what is certified, and the
mean what is refuted; between the two single runs may be calm for long and then are not.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.mean_square import decays_in_mean_square
from drake_formation.analysis.network.packet_schedule import PacketChannel, schedule
from drake_formation.analysis.network.packets import LARGEST, PacketTick, in_turn, packet_ticks
from drake_formation.analysis.network.rightmost_root import CONVERGED, rightmost_root

Array = NDArray[np.float64]

Label = Literal["stable", "unstable", "not certified"]
"""Whether every small deviation dies out: it is proven to, proven not to, or neither."""

UNDECIDED = 1e-9
"""A spectral radius this near to 1 is on neither side of it: rounding hides which."""

UNKNOWN: Label = "not certified"


@dataclass(frozen=True)
class ChannelVerdict:
    """What is certain about a linear system over its channels.

    Attributes:
        label: stable, unstable or not certified.
        reason: why, in a clause.
        growth_1_per_s: rate of the motion that decays slowest or grows fastest, without loss or in the mean (1/s); None
            where that is not known.
    """

    label: Label
    reason: str
    growth_1_per_s: float | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in their keys."""
        return {"label": self.label, "reason": self.reason, "growth_1_per_s": self.growth_1_per_s}


def packet_verdict(present: Array, channels: Sequence[PacketChannel]) -> ChannelVerdict:
    """Whether ẋ = A x + Σ_c into_c h_c, with what was heard last in packets, is stable.

    Args:
        present: A, shape (n, n).
        channels: at least one, all of which carry as many numbers.
    """
    try:
        ticks = packet_ticks(present, channels)
    except IllPosedError as error:
        return ChannelVerdict(UNKNOWN, str(error))
    whole = reduce(lambda before, tick: tick.mean @ before, ticks, np.eye(len(ticks[0].loop.base)))
    radius = float(np.abs(np.linalg.eigvals(whole)).max())
    growth = float(np.log(max(radius, np.finfo(float).tiny))) / (schedule(channels).tick * len(ticks))
    verdict = _by_growth(growth, hidden=abs(radius - 1) <= UNDECIDED)
    lossy = any(channel.loss > 0 for channel in channels)
    return _in_mean_square(verdict, ticks) if lossy and verdict.label != UNKNOWN else verdict


def _in_mean_square(mean: ChannelVerdict, ticks: list[PacketTick]) -> ChannelVerdict:
    """What becomes of a verdict on the mean."""
    growth = mean.growth_1_per_s
    if mean.label == "unstable":
        return ChannelVerdict("unstable", f"in the mean over what is lost, {mean.reason}", growth)
    if len(ticks) * len(ticks[0].loop.base) > LARGEST:
        reason = (
            f"it decays in the mean over what is lost; {len(ticks)} ticks that differ are too many for the mean square"
        )
        return ChannelVerdict(UNKNOWN, reason, growth)
    if not decays_in_mean_square(*in_turn(ticks)):
        reason = "it decays in the mean over what is lost, but its mean square grows: some runs go far astray"
        return ChannelVerdict(UNKNOWN, reason, growth)
    return ChannelVerdict("stable", f"its mean square decays; in the mean over what is lost, {mean.reason}", growth)


def delay_verdict(present: Array, delayed: Sequence[tuple[Array, float]]) -> ChannelVerdict:
    """Whether ẋ = A₀ x(t) + Σ A_k x(t − τ_k) is stable.

    Args:
        present: A₀, shape (n, n).
        delayed: A_k, of shape (n, n), and τ_k (s), not negative.
    """
    try:
        growth = rightmost_root(present, delayed).real
    except IllPosedError as error:
        return ChannelVerdict(UNKNOWN, str(error))
    size = np.linalg.norm(present) + sum(np.linalg.norm(matrix) for matrix, _ in delayed)
    return _by_growth(growth, hidden=bool(abs(growth) <= CONVERGED * size))


def _by_growth(growth: float, *, hidden: bool) -> ChannelVerdict:
    if hidden:
        return ChannelVerdict(UNKNOWN, "a motion decays or grows so slowly that rounding hides which", growth)
    if growth > 0:
        return ChannelVerdict("unstable", f"a motion grows at {growth:.3g} 1/s", growth)
    return ChannelVerdict("stable", f"every motion decays, the slowest at {-growth:.3g} 1/s", growth)
