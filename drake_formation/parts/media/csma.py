"""A medium that is listened to before anyone speaks (CSMA)."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.errors import Fault, shown
from drake_formation.formation.formation import Formation
from drake_formation.parts.media import access
from drake_formation.parts.media.shared import Radio, Retries, SharedMedium
from drake_formation.parts.registry import part


@part("medium", kind="csma")
class Csma(SharedMedium):
    """A station lets some idle slots pass, then sends; those that begin in the same slot do not hear each other.

    The number of slots is drawn from a window that is doubled after each failure in a row, and counted down while
    nobody in range is heard, as in IEEE 802.11 (Bianchi 2000, *IEEE Journal on Selected Areas in Communications*
    18(3)). Robots that do not hear each other may disturb a third one.
    """

    protocol = access.CSMA
    called_so = "CSMA"

    class Config(Radio):
        """How stations avoid each other."""

        slot: float = Field(
            default=2e-5, ge=1e-6, le=1.0, description="until another is heard (s); chosen: 20 µs, as IEEE 802.11b"
        )
        window: int = Field(default=16, ge=1, le=65536, description="of how many slots one is drawn first; chosen: 16")
        doublings: int = Field(default=6, ge=0, le=16, description="how often that is doubled at most; chosen: 6")
        retries: Retries = Field(
            default=6, description="after how many failures in a row a packet is given up; chosen: 6"
        )

    def slot(self, airtimes: NDArray[np.float64]) -> float:  # noqa: ARG002
        """As configured."""
        return float(self.config.slot)

    def settings(self, stations: int) -> dict[int, float]:  # noqa: ARG002
        """The window, and the retries."""
        window = float(self.config.window)
        widest = window * 2.0**self.config.doublings
        return {access.WINDOW: window, access.WIDEST: widest, access.RETRIES: self.config.retries}

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """As for all; and a slot is no longer than a frame."""
        yield from super().checks(formation, owner)
        sizes = [getattr(channel.config, "bits", np.inf) for channel in formation.parts["channel"]]
        shortest = self.airtime(min(sizes, default=np.inf))
        if self.config.slot > shortest:
            message = "a frame would be over before another robot hears it"
            yield Fault(("slot",), message, shown(self.config.slot), f"at most {shortest:g} s, the airtime of a packet")
