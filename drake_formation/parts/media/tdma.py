"""A medium in turns (TDMA)."""

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.values import NonNegative
from drake_formation.formation.formation import Formation
from drake_formation.parts.media import access
from drake_formation.parts.media.shared import Radio, SharedMedium
from drake_formation.parts.registry import part


@part("medium", kind="tdma")
class Tdma(SharedMedium):
    """Stations send in turn, a slot each, in the order of the channels; nobody collides, and nobody takes another's."""

    protocol = access.TDMA
    called_so = "TDMA"

    class Config(Radio):
        """Its slots."""

        guard: NonNegative = Field(default=0.0, description="time between slots, for clocks that differ (s)")

    def slot(self, airtimes: NDArray[np.float64]) -> float:
        """The longest frame, and the guard time."""
        return float(airtimes.max() + self.config.guard)

    def demand(self, formation: Formation) -> float:
        """A round of all slots, by the shortest period in which a channel sends."""
        periods = [channel.network.period for channel in formation.parts["channel"]]
        return float(len(self.stations(formation)) * self.slot(self.airtimes(formation)) / min(periods))
