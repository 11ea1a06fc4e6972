"""Named profiles of channels: what a user may write instead of numbers."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Profile:
    """What kind of network it is.

    Attributes:
        period: how often a robot tells its state (s).
        delay: mean delay (s).
        spread: half the width of the range of delays (s).
        loss: share of packets that are lost.
        burst: mean length of a burst of losses (packets).
        source: where the numbers come from.
    """

    period: float
    delay: float
    spread: float
    loss: float
    burst: float
    source: str


PROFILES: dict[str, Profile] = {
    "ideal": Profile(0.0, 0.0, 0.0, 0.0, 1.0, "a wire, as in the paper"),
    "urllc": Profile(1e-3, 1e-3, 0.0, 1e-6, 1.0, "of the order that 3GPP TS 22.104 sets out for motion control"),
    "factory": Profile(5e-3, 5e-3, 0.0, 1e-4, 1.0, "chosen: an industrial wireless network, 5 ms, one loss in 1e4"),
    "wifi": Profile(1e-2, 1e-2, 0.0, 1e-2, 1.0, "chosen: a wireless LAN that is little used, 10 ms, one loss in 100"),
    "lossy": Profile(1e-2, 3e-2, 1e-2, 0.1, 5.0, "chosen: a bad radio link, 30 ms, 10 % lost in bursts of five"),
    "saturated": Profile(2e-2, 0.1, 4e-2, 0.1, 1.0, "chosen: a network at its limit, 100 ms, 10 % lost"),
}
"""By name."""
