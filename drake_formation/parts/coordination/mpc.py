"""Model predictive control of the whole formation, with force limits and a distance to obstacles."""

from collections.abc import Hashable, Iterator
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.errors import Fault
from drake_formation.config.values import NonNegative, Positive
from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.linear_formation import formation_matrices, spring_matrix
from drake_formation.parts.coordination.mpc_controller import MpcController, Schedule
from drake_formation.parts.coordination.prediction import SampledModel, sampled
from drake_formation.parts.coordination.weights import FormationControl, Weights, input_cost, state_cost
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.systems.outlines import ROUND

Array = NDArray[np.float64]

Horizon = Annotated[int, Field(ge=1, le=100)]


class MpcConfig(Weights):
    """The cost, the samples and the constraints."""

    period: Positive = Field(
        default=0.2,
        description="time between plans (s), which are made at its multiples, one for all robots; chosen: 0.2",
    )
    horizon: Horizon = Field(
        default=20, description="samples that a plan reaches ahead, from 1 to 100, one for all robots; chosen: 20"
    )
    limit: Positive | None = Field(
        default=None, description="largest force in x and in y (N), one for all or one a robot; none where not given"
    )
    clearance: NonNegative | None = Field(
        default=None,
        description="least distance to the surface of known obstacles at every sample of the transport (m), one for "
        "all or one a robot; obstacles are ignored where not given",
    )


@part("coordination", kind="mpc")
class Mpc(FormationControl):
    """Receding horizon control of all robots and the object's linearized springs as one system, by Drake and OSQP.

    Every robot hears all others, solves the same quadratic program, and applies its own force until the next sample.
    It is the formation's one problem, and not one for each robot with predictions of its neighbours, as channels carry
    states and no plans: robots that know the same find the same plan and keep each other's constraints. Behind the
    horizon errors have the cost to go of the LQR, so that where no constraint binds the forces are the sampled LQR's.
    The reference is taken to keep its velocity. Distances hold at the samples, by the linear model; a robot dead ahead
    of an obstacle's centre waits there. This is the whole control, so ``tracking.kind`` is ``none``; with
    ``avoidance.gain`` 0 obstacles are its affair alone. No engine but ``blocks`` runs it.

    Source: D. Q. Mayne, J. B. Rawlings, C. V. Rao and P. O. M. Scokaert, "Constrained model predictive control:
    Stability and optimality", Automatica 36(6), 2000, Sec. 3.
    """

    Config = MpcConfig
    alike = ("relative_cost", "period", "horizon")

    def design(self, formation: Formation) -> object:
        """The models without and with the object."""
        return models(formation)

    def structure(self) -> Hashable:
        """When plans are made, and for how long."""
        return self.config.period, self.config.horizon

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """Limits, distances, slots, obstacles, and the models without and with the object."""
        configs = [part.config for part in formation.parts["coordination"]]
        limits = [np.inf if config.limit is None else config.limit for config in configs]
        kept = [-np.inf if config.clearance is None else config.clearance for config in configs]
        distances = kept + formation.footprints
        packed = (model.pack() for model in models(formation))
        return np.array(limits), distances, formation.slots, _known_discs(formation), *packed

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether it can plan at all, and keep the distances that are asked for."""
        yield from super().checks(formation, owner)
        if self.config.clearance is None:
            return
        for index, obstacle in enumerate(formation.obstacles):
            if obstacle.known and obstacle.layout != ROUND:
                message = "mpc plans around circles at rest alone"
                path = ("..", "avoidance", "obstacles", index)
                yield Fault(path, message, allowed="a circle that does not move, known: false, or no clearance of mpc")

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The controller, in double only."""
        return MpcController(owner, Schedule(self.config.period, self.config.horizon), numbers)


def _known_discs(formation: Formation) -> Array:
    """Centre and radius of each obstacle (m), shape (M, 3); of those that are unknown nothing is kept away from."""
    rows = [[*item.vertices[0], item.radius if item.known else -np.inf] for item in formation.obstacles]
    return np.array(rows, dtype=float).reshape(-1, 3)


KEPT = "mpc"
"""Where a formation keeps its models: they are made once, not once a robot."""


def models(formation: Formation) -> tuple[SampledModel, SampledModel]:
    """The sampled linear formation without the object and with its springs.

    Raises:
        One of NO_OPTIMUM: there is none.
    """
    if KEPT not in formation.kept:
        a, b = formation_matrices(formation.masses)
        costs = state_cost(formation), input_cost(formation), formation.parts["coordination"][0].config.period
        formation.kept[KEPT] = sampled(a, b, *costs), sampled(a + spring_matrix(formation), b, *costs)
    kept: tuple[SampledModel, SampledModel] = formation.kept[KEPT]
    return kept
