"""Local collision avoidance of one robot: Khatib's artificial potential field."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.formation.formation import Formation
from drake_formation.parts.avoidance.sensed_field import FieldConfig, SensedField
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.systems.scalars import Scalar, at_least, positive_part
from drake_formation.systems.templates import block_template, in_double

SURFACE = 1e-50
"""The least clearance that counts (m), so small that the force there, some 1e150 N, outlasts every shorter step."""

FieldLaw = Callable[..., tuple[Scalar, Scalar]]
"""``law(dx, dy, radius, range, *numbers, gain)``: force (N) on a robot at (dx, dy) from an obstacle's centre (m)."""


def avoidance_force(
    dx: Scalar, dy: Scalar, radius: Scalar, sensing_range: Scalar, gain: Scalar
) -> tuple[Scalar, Scalar]:
    """Repulsive force of one obstacle (Khatib 1986; the paper names an artificial potential function only).

    η (1/ρ − 1/ρ0)/ρ² along ∇ρ for a clearance ρ < ρ0, else zero. It grows beyond all bounds towards the surface, so
    that no motion reaches it, and inside it is as large as at the surface: whatever step would end there, or look
    there on its way, step control takes a shorter one.

    Args:
        dx: position of the robot relative to the obstacle's centre (m), x component.
        dy: its y component (m).
        radius: radius of the obstacle (m); 0 is a point.
        sensing_range: ρ0 (m).
        gain: η (N m²); at 0 there is no force anywhere, inside neither.

    Returns:
        Components of the force on the robot (N).
    """
    distance = (dx * dx + dy * dy + SURFACE * SURFACE) ** 0.5
    clearance = at_least(distance - radius, SURFACE)
    push = gain * positive_part(1.0 / clearance - 1.0 / sensing_range) / (clearance * clearance * distance)
    return push * dx, push * dy


@block_template("ObstacleAvoidance_", __name__)
def ObstacleAvoidance_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`ObstacleAvoidance`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The avoidance control of one robot: the sum of what its sensed obstacles exert during transport.

        Input ports: ``state`` (size 4), ``phase`` (0 aggregation, 1 transport: obstacles are felt), with masked
        sensing ``sensed`` (1 for each obstacle this robot is allowed to see, else 0), and per robot j that it keeps
        away from, in both phases, ``channel_j`` (the state it sends, size 4). Output port: ``force`` (N, size 2).
        Parameters: 0, the law's numbers and gain, for Khatib's [ρ0, η] (m, N m²); 1, for each obstacle its centre and
        radius (m, three numbers); and where it keeps away from robots 2, the range of the field around them (m).
        """

        def _construct(
            self,
            field: ArrayLike,
            obstacles: ArrayLike,
            masked: bool = False,
            law: FieldLaw = avoidance_force,
            neighbours: Sequence[int] = (),
            spacing: ArrayLike | None = None,
            *,
            converter: Any = None,
        ) -> None:
            """Make the controller.

            Args:
                field: the law's numbers, the gain last; for Khatib's [ρ0, η] (m, N m²).
                obstacles: centre and radius of each obstacle (m), shape (obstacles, 3).
                masked: declare the port ``sensed``.
                law: force of one obstacle; in proportion to the gain, and none without.
                neighbours: numbers of the robots it keeps away from (from 1), which name the channel ports.
                spacing: range of the field around those robots (m), shape (1,); None where there are none.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (field, obstacles, masked, law, neighbours, spacing)
            self.kind = (masked, law)  # all else that it computes with is a parameter
            count = len(np.reshape(obstacles, (-1, 3)))
            self._law = law
            self._zero = T(0.0)
            self._everything = [1.0] * count
            self._state = self.DeclareVectorInputPort("state", 4)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._channels = [self.DeclareVectorInputPort(f"channel_{j}", 4) for j in neighbours]
            self._sensed = self.DeclareVectorInputPort("sensed", count) if masked else None
            self.DeclareNumericParameter(BasicVector_[T](field))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(obstacles)))
            if spacing is not None:
                self.DeclareNumericParameter(BasicVector_[T](spacing))
            self.DeclareVectorOutputPort(
                "force", 2, self._calc_force, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            x, y, _, _ = self._state.Eval(context).tolist()
            (phase,) = self._phase.Eval(context).tolist()
            *numbers, gain = context.get_numeric_parameter(0).CopyToVector().tolist()
            obstacles = context.get_numeric_parameter(1).CopyToVector().reshape(-1, 3).tolist()
            sensed = self._sensed.Eval(context).tolist() if self._sensed else self._everything
            fx = fy = self._zero
            for seen, (ox, oy, radius) in zip(sensed, obstacles, strict=True):
                # What is not felt has no gain: inside an obstacle the force is too large to be multiplied away.
                gx, gy = self._law(x - ox, y - oy, radius, *numbers, phase * seen * gain)
                fx, fy = fx + gx, fy + gy  # += would change an Expression in place
            for port in self._channels:
                nx, ny, _, _ = port.Eval(context).tolist()
                (spacing,) = context.get_numeric_parameter(2).CopyToVector().tolist()
                gx, gy = self._law(x - nx, y - ny, 0.0, spacing, *numbers[1:], gain)
                fx, fy = fx + gx, fy + gy
            output.SetFromVector(np.array([fx, fy]))

    return Impl


ObstacleAvoidance = in_double(ObstacleAvoidance_)


@part("avoidance", kind="khatib")
class Khatib(SensedField):
    """Khatib's repulsive potential around obstacles sensed during transport."""

    Config = FieldConfig

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The field's range and gain, and the obstacles."""
        return np.array([self.config.range, self.config.gain]), self.felt(formation, owner), *self.spacing()

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        field, obstacles, *spacing = numbers
        others = self.neighbours(formation, owner)
        return ObstacleAvoidance(field, obstacles, self.masked, avoidance_force, others, *spacing)
