"""A bus on which the first identifier wins (CAN)."""

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from drake_formation.config.values import Section
from drake_formation.parts.media import access
from drake_formation.parts.media.shared import Shared, SharedMedium
from drake_formation.parts.registry import part


@part("medium", kind="priority")
class Priority(SharedMedium):
    """When the bus is free, of all that wait the first channel sends, and nothing is destroyed (ISO 11898-1, CAN).

    Channels have priority in the order in which they are listed. Everybody is on the bus. A frame that has begun is not
    interrupted, so that the first channel waits for one frame at most.
    """

    protocol = access.PRIORITY
    called_so = "a bus"

    Config: ClassVar[type[Section]] = Shared

    def slot(self, airtimes: NDArray[np.float64]) -> float:  # noqa: ARG002
        """A bit."""
        return 1.0 / float(self.config.bit_rate)
