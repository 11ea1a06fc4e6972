"""What the study found, by kind of graph: rigid in its slots or not, with or without a channel to spare."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from drake_formation.formation import graphs
from drake_formation.formation.rigidity import Rigidity, rigidity
from drake_formation.paper.bandwidth.runs import formation
from drake_formation.paper.bandwidth.study import Tried
from drake_formation.scenario import resolve


@dataclass(frozen=True)
class Findings:
    """The graphs that were tried, sorted.

    Attributes:
        tried: all of them; for each number of robots also none and all channels.
    """

    tried: Sequence[Tried]

    @cached_property
    def connected(self) -> list[Tried]:
        """Those with channels."""
        return [one for one in self.tried if one.channels]

    @cached_property
    def rigid(self) -> list[Tried]:
        """Those whose channels hold the shape by distances."""
        return [one for one in self.connected if one.rigid]

    @cached_property
    def minimally_rigid(self) -> list[Tried]:
        """Those of them that can spare no channel."""
        return [one for one in self.rigid if one.minimally_rigid]

    @cached_property
    def braced(self) -> list[Tried]:
        """Those of them that can."""
        return [one for one in self.rigid if not one.minimally_rigid]

    @cached_property
    def flexible(self) -> list[Tried]:
        """Those that leave a change of shape free."""
        return [one for one in self.connected if not one.rigid]

    @cached_property
    def only_here_flexible(self) -> list[Tried]:
        """Those of them that would be rigid with the robots in general position."""
        return [one for one in self.flexible if framework(one).generically_rigid]

    def of(self, robots: int) -> "Findings":
        """Those of so many robots."""
        return Findings([one for one in self.tried if one.robots == robots])

    @cached_property
    def alone(self) -> dict[int, Tried]:
        """Robots that do not talk, by their number."""
        return {one.robots: one for one in self.tried if not one.channels}

    @cached_property
    def complete(self) -> dict[int, Tried]:
        """Robots that all talk, by their number."""
        return {one.robots: one for one in self.tried if one.channels == one.robots * (one.robots - 1)}

    def ratios(self, tried: Iterable[Tried], law: str = "hookean", best: str = "hookean") -> list[float]:
        """Errors under a law as multiples of that of the complete graph under another."""
        return [one.errors[law] / self.complete[one.robots].errors[best] for one in tried]


def framework(one: Tried) -> Rigidity:
    """What distances over the channels of a graph hold, with the robots in their slots."""
    return rigidity(resolve(formation(one.robots)).slots, graphs.edges(one.graph))
