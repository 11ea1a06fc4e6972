"""The paper's computer: a wire."""

from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part


@part("computer", kind="continuous")
class ContinuousComputer(Part):
    """Control forces follow what is measured and heard at once, as the paper assumes."""

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> None:  # noqa: ARG002
        """None: the sum of the controllers' forces goes on as it is."""
        return
