"""Whether the shape of a formation is held by distances: over the channels, by the object's springs, by both together.

Consensus on displacements (paper, Eq. 15) holds the shape over any connected graph, as all robots share the axes along
which displacements are compared. Springs along lines, the object's (Eq. 2) and consensus on distances, need a graph
that is rigid in the plane, and leave the formation free to turn.
"""

from dataclasses import dataclass
from typing import Any

from drake_formation.formation.formation import Formation
from drake_formation.formation.graphs import Edge
from drake_formation.formation.rigidity import Rigidity, rigidity


@dataclass(frozen=True)
class HeldShape:
    """What distances hold of a formation's shape.

    Attributes:
        channels: distances between robots of which one hears the other.
        object: distances along the object's springs that have stiffness.
        together: both.
        distances: whether the robots do compare distances, and not displacements or nothing.
    """

    channels: Rigidity
    object: Rigidity
    together: Rigidity
    distances: bool

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        frameworks = {name: getattr(self, name).to_dict() for name in ("channels", "object", "together")}
        return frameworks | {"consensus_on_distances": self.distances}

    def meaning(self) -> list[str]:
        """What the numbers say, a sentence each."""
        needed = self.channels.needed
        sentences = [
            f"Distances hold the shape, up to a rotation, where 2N - 3 = {needed} of them are independent (Laman).",
            f"Over the channels: {_in_words(self.channels)}.",
            f"Along the object's springs: {_in_words(self.object)}.",
        ]
        if not self.channels.rigid and not self.object.rigid:
            sentences.append(f"Both together: {_in_words(self.together)}.")
        if self.distances:
            sentences.append(
                "Robots compare distances, so consensus resists neither the rotation nor what its channels leave free."
            )
        return sentences


def held_shape(formation: Formation) -> HeldShape:
    """Count what distances hold of a formation's shape, in its slots.

    Args:
        formation: any scenario resolved, whatever its laws are.
    """
    channels = formation.channels.counted
    springs = stiff_springs(formation)
    laws = {getattr(part.config, "law", None) for part in formation.parts["coordination"]}
    return HeldShape(
        channels=rigidity(formation.slots, channels),
        object=rigidity(formation.slots, springs),
        together=rigidity(formation.slots, sorted({*channels, *springs})),
        distances=laws == {"hookean"},
    )


def _in_words(found: Rigidity) -> str:
    counted = f"{found.edges} distances of rank {found.rank}"
    if not found.rigid:
        elsewhere = "; with the robots in general position there would be none" if found.generically_rigid else ""
        return f"{counted}, {found.mechanisms} change{'s' * (found.mechanisms != 1)} of shape free{elsewhere}"
    spare = "minimally rigid" if found.minimally_rigid else f"rigid, {found.edges - found.needed} more than needed"
    return f"{counted}, {spare}; the softest change of shape meets {found.softest:.3g} times a spring's stiffness"


def stiff_springs(formation: Formation) -> list[Edge]:
    """The object's springs that have stiffness, robots numbered from 0."""
    stiffness = formation.field("spring", "stiffness")
    return [(i, j) for (i, j), k in zip(formation.springs.pairs.tolist(), stiffness, strict=True) if k > 0]
