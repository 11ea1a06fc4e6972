"""The paper's sensors: a wire."""

from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part


@part("sensor", kind="ideal")
class IdealSensor(Part):
    """A robot knows its state at once and exactly, as the paper assumes."""

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> None:  # noqa: ARG002
        """None: what asks for the robot's state is wired to its plant."""
        return
