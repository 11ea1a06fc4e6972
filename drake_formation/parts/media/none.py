"""No medium: every channel has its own."""

from typing import Any

from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part


@part("medium", kind="none")
class NoMedium(Part):
    """Nothing is shared: a packet is on its way as soon as it is sent."""

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """There is none."""
        return None
