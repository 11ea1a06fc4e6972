"""A medium that everybody uses as he likes, slot by slot (slotted ALOHA)."""

import math
from typing import Annotated

from pydantic import Field

from drake_formation.parts.media import access
from drake_formation.parts.media.shared import Radio, Retries, SharedMedium
from drake_formation.parts.registry import part


@part("medium", kind="aloha")
class Aloha(SharedMedium):
    """A station with a packet sends in each slot by chance; where two do so at once, neither is understood.

    Slots begin at whole multiples of their length. Whether a frame got through is known at its end. Of a throughput
    S = G exp(-G) at G frames a slot, 1/e is the most (Roberts 1975, *ACM SIGCOMM Computer Communication Review* 5(2)).
    """

    protocol = access.ALOHA
    capacity = math.exp(-1.0)
    called_so = "slotted ALOHA"

    class Config(Radio):
        """How eager stations are."""

        probability: Annotated[float, Field(gt=0, le=1)] | None = Field(
            default=None,
            description="probability (1) to send in a slot, halved after every failure in a row; chosen: 1 by the "
            "stations",
        )
        retries: Retries = Field(default=6, description="failures in a row after which it gives a packet up; chosen: 6")

    def settings(self, stations: int) -> dict[int, float]:
        """The chance to send, and the retries."""
        chance = self.config.probability
        return {access.PROBABILITY: 1.0 / stations if chance is None else chance, access.RETRIES: self.config.retries}
