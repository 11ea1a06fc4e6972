"""The distributed LQR of identical robots: each uses its own error and those of the robots that it hears."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from pydantic import Field

from drake_formation.config.errors import Fault
from drake_formation.config.values import CostMatrix, Positive
from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.distributed_gains import DistributedGains, distributed_gains
from drake_formation.parts.coordination.state_feedback import StateFeedback
from drake_formation.parts.coordination.weights import NO_OPTIMUM, Weights, together_faults, weight_faults
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.costs import cost_matrix


class DistributedWeights(Weights):
    """The weights of the cost, and how much the graph counts."""

    relative_cost: CostMatrix = Field(
        default=1.0,
        description="Q₂ (1/m², s²/m²), cost of the difference of two robots' errors, 4 x 4: a number times I, a "
        "diagonal or a matrix, one for all robots; chosen: I",
    )
    scale: Positive | None = Field(
        default=None,
        description="a (1) in M = a L, one for all robots; if not given, 1 where that is stable without springs, else "
        "what the theorem asks for",
    )


@part("coordination", kind="distributed_lqr")
class DistributedLqr(Part):
    """The distributed LQR of identical robots, each using the robots it hears (Borrelli and Keviczky, 2008).

    This is the whole control, K₁ included, so ``tracking.kind`` is ``none``. Springs play no part in the design.
    """

    Config = DistributedWeights

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether robots are alike, talk both ways over a connected graph, and the design is stable."""
        faults = [*weight_faults(self.config), *together_faults(formation, owner, ("Q", "R", "relative_cost", "scale"))]
        faults += [*_mass_faults(formation), *_graph_faults(formation)]
        yield from faults
        if faults:
            return
        try:
            stable = designed(formation).decay > 0
        except NO_OPTIMUM:
            stable = False
        if not stable:
            message = "the design leaves a mode unstable even without springs"
            yield Fault((), message, allowed="weights and masses of less different sizes, and a larger scale or none")

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """Slots of the robot and of those it hears, and its rows of I ⊗ K₁ + M ⊗ K₂."""
        robots = [owner, *formation.channels.heard[owner]]
        gains, laplacian = designed(formation), formation.channels.laplacian
        own = gains.local + laplacian[owner, owner] * gains.relative
        return formation.slots[robots], np.hstack([own, *(laplacian[owner, j] * gains.relative for j in robots[1:])])

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        return StateFeedback([j + 1 for j in formation.channels.heard[owner]], *numbers)


KEPT = "distributed_lqr"
"""Where a formation keeps its design: it is made once, not once a robot."""


def designed(formation: Formation) -> DistributedGains:
    """The design for a formation whose robots are alike and talk over a connected graph."""
    if KEPT not in formation.kept:
        config = formation.parts["coordination"][0].config
        costs = cost_matrix(config.Q, 4), cost_matrix(config.R, 2), cost_matrix(config.relative_cost, 4)
        gains = distributed_gains(float(formation.masses[0]), formation.channels.laplacian, *costs, scale=config.scale)
        formation.kept[KEPT] = gains
    kept: DistributedGains = formation.kept[KEPT]
    return kept


def _mass_faults(formation: Formation) -> Iterator[Fault]:
    masses = formation.masses
    if np.ptp(masses) > 0:
        message = (
            f"masses run from {masses.min():g} to {masses.max():g} kg, and a distributed LQR is for identical robots"
        )
        yield Fault(("..", "robots", "mass"), message, allowed="one for all robots")


def _graph_faults(formation: Formation) -> Iterator[Fault]:
    channels = formation.channels
    if not channels.undirected:
        message = "channels go one way or weigh differently each way"
        yield Fault(("graph",), message, allowed="channels both ways alike")
    elif not channels.agree:
        yield Fault(("graph",), "it is in parts that never hear of each other", allowed="a connected graph")
