"""Avoidance that keeps a clearance: a second-order control barrier function corrects what else moves the robot."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import Length, Positive, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.avoidance.barrier_function import barrier_force, smooth_barrier
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.systems.outlines import ROUND
from drake_formation.systems.templates import block_template, in_double


@block_template("BarrierFilter_", __name__)
def BarrierFilter_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The filter as a template over double, AutoDiffXd and Expression; see :class:`BarrierFilter`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """What one robot adds to its control during transport so that it keeps clear of all obstacles.

        Input ports: ``state`` (size 4), ``phase`` (0 aggregation, 1 transport: obstacles are felt), ``nominal`` and
        ``spring_force``, the forces of the other controllers and of the object (N, size 2). Output port: ``force``
        (N, size 2). Parameters: 0, [m, d, λ, κ] (kg, m, 1/s, 1/m); 1, for each obstacle its centre and radius (m,
        three numbers).
        """

        def _construct(self, field: ArrayLike, obstacles: ArrayLike, *, converter: Any = None) -> None:
            """Make the filter.

            Args:
                field: [m, d, λ, κ] (kg, m, 1/s, 1/m).
                obstacles: centre and radius of each obstacle (m), shape (obstacles, 3).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (field, obstacles)
            self.kind = "barrier"  # all else that it computes with is a parameter
            self._still = np.array([T(0.0), T(0.0)])
            self._state = self.DeclareVectorInputPort("state", 4)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._nominal = self.DeclareVectorInputPort("nominal", 2)
            self._object = self.DeclareVectorInputPort("spring_force", 2)
            self.DeclareNumericParameter(BasicVector_[T](field))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(obstacles)))
            self.DeclareVectorOutputPort(
                "force", 2, self._calc_force, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            discs = context.get_numeric_parameter(1).CopyToVector().reshape(-1, 3).tolist()
            if not discs:
                output.SetFromVector(self._still)
                return
            x, y, vx, vy = self._state.Eval(context).tolist()
            (phase,) = self._phase.Eval(context).tolist()
            ux, uy = self._nominal.Eval(context).tolist()
            sx, sy = self._object.Eval(context).tolist()
            field = context.get_numeric_parameter(0).CopyToVector().tolist()
            fx, fy = barrier_force((x, y), (vx, vy), (ux + sx, uy + sy), discs, *field)
            output.SetFromVector(np.array([phase * fx, phase * fy]))

    return Impl


BarrierFilter = in_double(BarrierFilter_)


def _discs(formation: Formation, owner: int) -> NDArray[np.float64]:
    """Centre of each obstacle, and its radius and that of the robot's footprint together (m), shape (M, 3)."""
    discs: NDArray[np.float64] = formation.obstacles.discs + np.array([0.0, 0.0, formation.footprints[owner]])
    return discs


@part("avoidance", kind="barrier")
class Barrier(Part):
    """A control barrier function that keeps a clearance from all obstacles, whatever else acts on the robot.

    The robot stops dead ahead of an obstacle, as it does by any filter that changes as little as it can.
    """

    class Config(Section):
        """What it keeps, and how."""

        clearance: Length = Field(default=0.3, description="clearance d (m), the least to any obstacle; chosen: 0.3")
        rate: Positive = Field(
            default=1.0,
            description="rate λ (1/s) at which the robot may use up the distance that it has to spare; the larger, the "
            "later and the harder it brakes; chosen: 1",
        )
        sharpness: Positive = Field(
            default=20.0,
            description="sharpness κ (1/m) of the smooth minimum, which among M obstacles keeps ln(M)/κ more than the "
            "clearance at the most; chosen: 20",
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether the robot keeps the clearance where obstacles begin to be felt, and moves as the forces on it say."""
        robot = formation.parts["robot"][owner].config
        for name in ("drag", "wheel_force_limit"):
            if value := getattr(robot, name, None):
                message = f"the barrier takes robot {owner + 1} for a mass that its forces alone move, without limit"
                yield Fault(("..", "robots", name), message, shown(value), "not given, or another avoidance.kind")
        for index, obstacle in enumerate(formation.obstacles):
            if obstacle.layout != ROUND:
                message = "the barrier keeps its clearance from circles at rest alone"
                yield Fault(
                    ("obstacles", index), message, allowed="circles that do not move, or another avoidance.kind"
                )
        if not len(formation.obstacles) or not formation.obstacles.are_circles:
            return
        if formation.robots > 1 and not formation.slots.any():
            return  # slots that coincide are told of already
        start = formation.starts[owner]
        place = formation.centre + formation.slots[owner] if formation.aggregation_duration else start
        config, discs = self.config, _discs(formation, owner).tolist()
        spare, _, _ = smooth_barrier(
            tuple(place.tolist()), (0.0, 0.0), discs, config.clearance, config.rate, config.sharpness
        )
        if spare < 0:
            message = f"robot {owner + 1} begins at {shown(place.tolist())} with {-spare:.3g} m less to the obstacles"
            allowed = "a smaller clearance, a larger sharpness, or a start farther from them"
            yield Fault(("clearance",), message, shown(config.clearance), allowed)

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """Mass, clearance, rate and sharpness; and the obstacles."""
        config = self.config
        field: NDArray[np.float64] = np.array(
            [formation.masses[owner], config.clearance, config.rate, config.sharpness]
        )
        return field, _discs(formation, owner)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The filter."""
        return BarrierFilter(*numbers)
