"""The carried object as springs between the robots (paper, Eq. 2), which their plants carry out."""

from drake_formation.formation.formation import SPRINGS, Formation
from drake_formation.parts.objects.breaking import LookNumbers
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part


@part("object", kind=SPRINGS)
class Springs(Part):
    """Springs between the robots, without a mass, as the section springs says (paper, Eq. 2)."""

    Config = LookNumbers

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> None:
        """None: the springs are in the robots' plants."""
