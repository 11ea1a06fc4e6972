"""The paper's actuators: a wire."""

from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part


@part("actuator", kind="ideal")
class IdealActuator(Part):
    """What is asked is exerted, at once and exactly, as the paper assumes."""

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> None:  # noqa: ARG002
        """None: the plant's port is wired to what is asked."""
        return
