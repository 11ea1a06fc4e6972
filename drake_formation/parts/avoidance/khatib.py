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
from drake_formation.systems.outlines import Layout, circles, offsets
from drake_formation.systems.scalars import Scalar, at_least, positive_part
from drake_formation.systems.templates import block_template, in_double

SURFACE = 1e-50
"""The least clearance that counts (m), so small that the force there, some 1e150 N, outlasts every shorter step."""

TOUCH = 0.1
"""How near to contact a footprint's clearance counts at the least, as a share of its radius."""

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
    push = field_strength(at_least(distance - radius, SURFACE), sensing_range, gain, distance)
    return push * dx, push * dy


def field_strength(clearance: Scalar, sensing_range: Scalar, gain: Scalar, distance: Scalar) -> Scalar:
    """The force at a clearance ρ for every metre of the distance from what exerts it (N/m).

    Args:
        clearance: ρ, above 0 (m).
        sensing_range: ρ0 (m).
        gain: η (N m²).
        distance: by which it is shared out to the components (m).
    """
    return gain * positive_part(1.0 / clearance - 1.0 / sensing_range) / (clearance * clearance * distance)


def at_contact(dx: Scalar, dy: Scalar, radius: Scalar, footprint: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """Where the field of an obstacle is felt by a robot with a footprint: no nearer than ``TOUCH`` of it to contact.

    So a footprint that touches is pushed away by a great but finite force.

    Args:
        dx: position of the robot relative to what is nearest of the obstacle (m), x component.
        dy: its y component (m).
        radius: of the obstacle (m).
        footprint: radius of the robot's footprint (m).

    Returns:
        The position at which the field is felt (m), and the distance at which the footprint touches (m).
    """
    touching = radius + footprint
    distance = (dx * dx + dy * dy + SURFACE * SURFACE) ** 0.5
    stretched = at_least(distance, touching + TOUCH * footprint) / distance
    return stretched * dx, stretched * dy, touching


@block_template("ObstacleAvoidance_", __name__)
def ObstacleAvoidance_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`ObstacleAvoidance`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The avoidance control of one robot: the sum of what its sensed obstacles exert during transport.

        Input ports: ``state`` (size 4), ``phase`` (0 aggregation, 1 transport: obstacles are felt), with masked
        sensing ``sensed`` (1 for each obstacle this robot is allowed to see, else 0), with a line of sight ``visible``
        (1 for each obstacle that nothing hides from it, else 0), and per robot j that it keeps away from, in both
        phases, ``channel_j`` (the state it sends, size 4). Output port: ``force`` (N, size 2). Parameters: 0, the law's
        numbers and gain, for Khatib's [ρ0, η] (m, N m²); 1, the obstacles, for each circle its centre and radius (m,
        three numbers), others as :mod:`drake_formation.systems.outlines` says; where it keeps away from robots 2, the
        range of the field around them (m); and last, where robots have footprints, the radius of its own and of each
        such robot's (m).
        """

        def _construct(
            self,
            field: ArrayLike,
            obstacles: ArrayLike,
            masked: bool = False,
            law: FieldLaw = avoidance_force,
            neighbours: Sequence[int] = (),
            spacing: ArrayLike | None = None,
            footprints: ArrayLike | None = None,
            layout: Layout | None = None,
            sighted: bool = False,
            *,
            converter: Any = None,
        ) -> None:
            """Make the controller.

            Args:
                field: the law's numbers, the gain last; for Khatib's [ρ0, η] (m, N m²).
                obstacles: the numbers of the obstacles; for circles of shape (obstacles, 3).
                masked: declare the port ``sensed``.
                law: force of one obstacle; in proportion to the gain, and none without.
                neighbours: numbers of the robots it keeps away from (from 1), which name the channel ports.
                spacing: range of the field around those robots (m), shape (1,); None where there are none.
                footprints: radius of its own footprint and of its neighbours' (m); None where all are points.
                layout: of the obstacles' numbers; circles at rest where there is none.
                sighted: declare the port ``visible``.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (field, obstacles, masked, law, neighbours, spacing, footprints, layout, sighted)
            self._layout = circles(np.size(obstacles) // 3) if layout is None else layout
            self.kind = (masked, law, self._layout, sighted, footprints is not None)  # all else is a parameter
            self._law = law
            self._zero = T(0.0)
            count = len(self._layout)
            self._state = self.DeclareVectorInputPort("state", 4)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._channels = [self.DeclareVectorInputPort(f"channel_{j}", 4) for j in neighbours]
            self._everything = [1.0] * count
            self._sensed = self.DeclareVectorInputPort("sensed", count) if masked else None
            self._visible = self.DeclareVectorInputPort("visible", count) if sighted else None
            optional = [group for group in (spacing, footprints) if group is not None]
            for group in (field, np.ravel(obstacles), *optional):
                self.DeclareNumericParameter(BasicVector_[T](group))
            self._footprints = 1 + len(optional) if footprints is not None else None
            self._moving = any(pieces for _, pieces in self._layout)
            prerequisites = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            if self._moving:
                prerequisites.add(self.time_ticket())
            self.DeclareVectorOutputPort("force", 2, self._calc_force, prerequisites)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            x, y, _, _ = self._state.Eval(context).tolist()
            (phase,) = self._phase.Eval(context).tolist()
            *numbers, gain = context.get_numeric_parameter(0).CopyToVector().tolist()
            obstacles = context.get_numeric_parameter(1).CopyToVector().tolist()
            sensed = self._sensed.Eval(context).tolist() if self._sensed else self._everything
            if self._visible:
                sensed = [a * b for a, b in zip(sensed, self._visible.Eval(context).tolist(), strict=True)]
            radii = context.get_numeric_parameter(self._footprints).CopyToVector().tolist() if self._footprints else ()
            time = context.get_time() if self._moving else 0.0
            fx = fy = self._zero
            for seen, (dx, dy, radius) in zip(sensed, offsets(x, y, time, obstacles, self._layout), strict=True):
                felt = at_contact(dx, dy, radius, radii[0]) if radii else (dx, dy, radius)
                # What is not felt has no gain: inside an obstacle the force is too large to be multiplied away.
                gx, gy = self._law(*felt, *numbers, phase * seen * gain)
                fx, fy = fx + gx, fy + gy  # += would change an Expression in place
            for k, port in enumerate(self._channels):
                nx, ny, _, _ = port.Eval(context).tolist()
                (spacing,) = context.get_numeric_parameter(2).CopyToVector().tolist()
                felt = at_contact(x - nx, y - ny, radii[1 + k], radii[0]) if radii else (x - nx, y - ny, 0.0)
                gx, gy = self._law(*felt, spacing, *numbers[1:], gain)
                fx, fy = fx + gx, fy + gy
            output.SetFromVector(np.array([fx, fy]))

    return Impl


ObstacleAvoidance = in_double(ObstacleAvoidance_)


@part("avoidance", kind="khatib")
class Khatib(SensedField):
    """Khatib's repulsive potential around obstacles sensed during transport."""

    Config = FieldConfig

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The field's range and gain, the obstacles, and what it knows of robots."""
        field = np.array([self.config.range, self.config.gain])
        return field, self.felt(formation, owner).numbers, *self.of_robots(formation, owner)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        return field_block(self, formation, owner, numbers, avoidance_force)


def field_block(part: SensedField, formation: Formation, owner: int, numbers: Numbers, law: FieldLaw) -> Any:
    """The controller of a robot by a field's law."""
    field, obstacles, *of_robots = numbers
    spacing = of_robots.pop(0) if part.config.robots else None
    footprints = of_robots.pop(0) if of_robots else None
    layout, others = part.felt(formation, owner).layout, part.neighbours(formation, owner)
    sighted = part.config.line_of_sight
    return ObstacleAvoidance(field, obstacles, part.masked, law, others, spacing, footprints, layout, sighted)
