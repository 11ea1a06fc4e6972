"""What an optimal control of the whole formation costs, and what it takes for a robot to carry it out."""

from collections.abc import Iterator
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.errors import Fault, shortened, shown
from drake_formation.config.values import CostMatrix, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.linear_formation import block_diagonal
from drake_formation.parts.part import Part
from drake_formation.parts.tracking.costs import (
    cost_matrix,
    input_cost_faults,
    is_semidefinite,
    matrix_faults,
    state_cost_faults,
)

Array = NDArray[np.float64]


class Weights(Section):
    """The cost ∫ Σ_i (ε_iᵀ Q ε_i + u_iᵀ R u_i) + Σ_{i<j} (ε_i − ε_j)ᵀ Q₂ (ε_i − ε_j) dt (Borrelli and Keviczky, 2008).

    ε_i is a robot's tracking error and u_i its control force.
    """

    Q: CostMatrix = Field(
        default=1.0,
        description="cost of a robot's error (1/m², s²/m²), 4 x 4: a number times I, a diagonal or a matrix; chosen: I",
    )
    R: CostMatrix = Field(
        default=1.0, description="cost of its force (1/N²), 2 x 2: a number times I, a diagonal or a matrix; chosen: I"
    )
    relative_cost: CostMatrix = Field(
        default=0.0,
        description="Q₂ (1/m², s²/m²), cost of the difference of two robots' errors, 4 x 4: a number times I, a "
        "diagonal or a matrix, one for all robots; chosen: none",
    )


def state_cost(formation: Formation) -> Array:
    """What the errors of all robots cost, over all pairs of robots, shape (4N, 4N)."""
    configs = [part.config for part in formation.parts["coordination"]]
    count = len(configs)
    pairs: Array = count * np.eye(count) - np.ones((count, count))
    own = block_diagonal(cost_matrix(config.Q, 4) for config in configs)
    between = np.kron(pairs, cost_matrix(configs[0].relative_cost, 4))
    return own + between.astype(np.float64)


def input_cost(formation: Formation) -> Array:
    """What the forces of all robots cost, shape (2N, 2N)."""
    return block_diagonal(cost_matrix(part.config.R, 2) for part in formation.parts["coordination"])


def weight_faults(weights: Weights) -> Iterator[Fault]:
    """What is wrong with a robot's weights by themselves."""
    yield from state_cost_faults(weights.Q)
    yield from input_cost_faults(weights.R)
    path, allowed = ("relative_cost",), "symmetric, positive semi-definite 4 x 4"
    if faults := list(matrix_faults(path, weights.relative_cost, 4, allowed)):
        yield from faults
    elif not is_semidefinite(cost_matrix(weights.relative_cost, 4)):
        yield Fault(path, "not positive semi-definite", shown(weights.relative_cost), allowed)


def together_faults(formation: Formation, owner: int, alike: tuple[str, ...]) -> Iterator[Fault]:
    """Whether all robots are under one control: of one kind, with some fields alike, and no other one for tracking."""
    part: Part = formation.parts["coordination"][owner]
    for j, other in enumerate(formation.parts["coordination"]):
        if type(other) is not type(part):
            message = f"robot {j + 1} coordinates by {other.kind!r}, but {part.kind!r} is the control of all robots"
            yield Fault(("kind",), message, other.kind, f"{part.kind} for all robots")
            return
    configs = [other.config for other in formation.parts["coordination"]]
    for name in alike:
        if any(getattr(config, name) != getattr(configs[0], name) for config in configs):
            yield Fault((name,), "robots have different ones", allowed="one for all robots")
    tracking: Part = formation.parts["tracking"][owner]
    if tracking.kind != "none":
        message = f"{part.kind!r} is the whole control and takes no account of the force of {tracking.kind!r}"
        yield Fault(("..", "tracking", "kind"), message, tracking.kind, "none")


def hearing_faults(formation: Formation, owner: int) -> Iterator[Fault]:
    """Whether a robot hears all others."""
    missing = sorted(set(range(formation.robots)) - {owner, *formation.channels.heard[owner]})
    if missing:
        others = f"robot{'s' if len(missing) > 1 else ''} {shortened(', '.join(str(j + 1) for j in missing))}"
        message = f"robot {owner + 1} does not hear {others}, and its force depends on the state of every robot"
        yield Fault(("graph",), message, allowed="complete, or a channel to every robot from every other")


class FormationControl(Part):
    """One optimal control of all robots, which each carries out for itself and so hears all others for."""

    alike: ClassVar[tuple[str, ...]]
    """Fields that are one for all robots."""

    def design(self, formation: Formation) -> object:
        """The optimum, which is kept with the formation.

        Raises:
            One of NO_OPTIMUM: there is none.
        """
        raise NotImplementedError

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether every robot hears all others, is under this control alone, and the cost has an optimum."""
        faults = [*weight_faults(self.config), *together_faults(formation, owner, self.alike)]
        faults += hearing_faults(formation, owner)
        yield from faults
        if faults or not can_be_designed(formation):
            return
        try:
            self.design(formation)
        except NO_OPTIMUM:
            yield no_optimum()


NO_OPTIMUM = (RuntimeError, ArithmeticError, np.linalg.LinAlgError, SystemExit)
"""What is raised where there is no optimal control; SystemExit is how Drake reports a failed demand."""


def no_optimum() -> Fault:
    """What is then said."""
    message = "Drake finds no stabilizing gain for the formation linearized about its slots"
    return Fault((), message, allowed="Q, R, masses and springs of less different sizes")


def can_be_designed(formation: Formation) -> bool:
    """Whether an optimum can be looked for: all robots' weights are sound, and no spring joins two slots that are one.

    What is wrong otherwise is told by others.
    """
    weights = (part.config for part in formation.parts["coordination"])
    return bool(formation.rest_lengths.all()) and not any(fault for one in weights for fault in weight_faults(one))
