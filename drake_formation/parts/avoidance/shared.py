"""Avoidance with shared knowledge: a robot also yields to obstacles that those it hears sense."""

from collections.abc import Hashable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.values import NonNegative
from drake_formation.formation.formation import Formation
from drake_formation.parts.avoidance.khatib import SURFACE, at_contact, avoidance_force, field_strength
from drake_formation.parts.avoidance.sensed_field import FieldStrength
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.systems.outlines import Layout, offsets
from drake_formation.systems.scalars import Scalar, at_least
from drake_formation.systems.templates import block_template, in_double

NEAREST = 0.1
"""How near to contact a robot that is heard is taken to be at the least, as a share of the field's range."""


def told_force(
    dx: Scalar, dy: Scalar, radius: Scalar, footprint: Scalar, sensing_range: Scalar, gain: Scalar
) -> tuple[Scalar, Scalar]:
    """Khatib's force on a robot that is heard, from where it says it is.

    What is heard may be late, and then inside of what the robot has gone round; there it would be beyond all bounds.
    So it is worked out no nearer than ``NEAREST`` of the range to contact.

    Args:
        dx: where the robot says it is, relative to what is nearest of the obstacle (m), x component.
        dy: its y component (m).
        radius: of the obstacle (m).
        footprint: radius of that robot's footprint (m).
        sensing_range: ρ0 (m).
        gain: η (N m²), times the share that is given way to.

    Returns:
        Components of the force (N).
    """
    distance = (dx * dx + dy * dy + SURFACE * SURFACE) ** 0.5
    clearance = at_least(distance - radius - footprint, NEAREST * sensing_range)
    push = field_strength(clearance, sensing_range, gain, distance)
    return push * dx, push * dy


@block_template("SharedAvoidance_", __name__)
def SharedAvoidance_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`SharedAvoidance`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The avoidance control of one robot that is told what others sense, during transport.

        Input ports: ``state`` (size 4), ``phase`` (0 aggregation, 1 transport: obstacles are felt), and per robot j
        that it hears ``channel_j`` (the state it sends, size 4). Output port: ``force`` (N, size 2). Parameters: 0,
        [ρ0, η, share] (m, N m², 1); 1, the obstacles, as :mod:`drake_formation.systems.outlines` says; 2, the radius
        of its own footprint and of those of the robots that it hears (m).
        """

        def _construct(
            self,
            field: ArrayLike,
            obstacles: ArrayLike,
            radii: ArrayLike,
            heard: tuple[int, ...],
            layout: Layout,
            *,
            converter: Any = None,
        ) -> None:
            """Make the controller.

            Args:
                field: [ρ0, η, share] (m, N m², 1).
                obstacles: the numbers of the obstacles.
                radii: of its own footprint and of those of the robots that it hears (m).
                heard: numbers of those robots (from 1), which name the channel ports.
                layout: of the obstacles' numbers.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (field, obstacles, radii, heard, layout)
            self.kind = (layout, len(heard))  # all else is a parameter
            self._layout = layout
            self._zero = T(0.0)
            self._state = self.DeclareVectorInputPort("state", 4)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._channels = [self.DeclareVectorInputPort(f"channel_{j}", 4) for j in heard]
            for group in (field, np.ravel(obstacles), radii):
                self.DeclareNumericParameter(BasicVector_[T](group))
            self._moving = any(pieces for _, pieces in layout)
            prerequisites = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            if self._moving:
                prerequisites.add(self.time_ticket())
            self.DeclareVectorOutputPort("force", 2, self._calc_force, prerequisites)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            x, y, _, _ = self._state.Eval(context).tolist()
            (phase,) = self._phase.Eval(context).tolist()
            sensing_range, gain, share = context.get_numeric_parameter(0).CopyToVector().tolist()
            obstacles = context.get_numeric_parameter(1).CopyToVector().tolist()
            own, *others = context.get_numeric_parameter(2).CopyToVector().tolist()
            time = context.get_time() if self._moving else 0.0
            fx = fy = self._zero
            for dx, dy, radius in offsets(x, y, time, obstacles, self._layout):
                gx, gy = avoidance_force(*at_contact(dx, dy, radius, own), sensing_range, phase * gain)
                fx, fy = fx + gx, fy + gy  # += would change an Expression in place
            for port, footprint in zip(self._channels, others, strict=True):
                nx, ny, _, _ = port.Eval(context).tolist()
                for dx, dy, radius in offsets(nx, ny, time, obstacles, self._layout):
                    gx, gy = told_force(dx, dy, radius, footprint, sensing_range, phase * share * gain)
                    fx, fy = fx + gx, fy + gy
            output.SetFromVector(np.array([fx, fy]))

    return Impl


SharedAvoidance = in_double(SharedAvoidance_)


@part("avoidance", kind="shared")
class Shared(Part):
    """Khatib's field, felt by a robot at its own place and at those of the robots it hears.

    It yields to f(x_i) + share Σ_j f(x̂_j), j over the robots that it hears, with f the force of all obstacles
    (:func:`drake_formation.parts.avoidance.khatib.avoidance_force`) and x̂_j the state of robot j as it comes over the
    channel: late, held, predicted or lost as that says. With complete ideal channels, share 1 and one range, gain and
    footprint for all, every robot yields to the same force, and so equal masses stay in formation past an obstacle.

    Assumed is that with its state a robot tells of each obstacle that it senses where that is, and where it moves to,
    in the same packet, whose size does not count it; that the robot that hears works out the force by its own range and
    gain; and that of obstacles which several sense it counts what each of them feels. A robot that is dropped is taken
    to be in its slot beside the robot that hears, and to feel what it would feel there.
    """

    class Config(FieldStrength):
        """Range and strength of the field, and how much what others feel counts."""

        share: NonNegative = Field(
            default=1.0, description="how much of the force on each robot heard is yielded to (1); 0 is khatib"
        )

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The field's range, gain and share, the obstacles, and footprints."""
        field = np.array([self.config.range, self.config.gain, self.config.share])
        heard = list(formation.channels.heard[owner])
        return field, formation.obstacles.numbers, formation.footprints[[owner, *heard]]

    def layout(self, formation: Formation, owner: int) -> Hashable:  # noqa: ARG002
        """The shapes of the obstacles, and whether they move."""
        return formation.obstacles.layout

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        heard = tuple(j + 1 for j in formation.channels.heard[owner])
        return SharedAvoidance(*numbers, heard, formation.obstacles.layout)
