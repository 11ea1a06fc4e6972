"""A rigid object: a body in the plane with mass, inertia and friction, held at one point by each robot."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import Field

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import NonNegative, Positive
from drake_formation.formation.formation import Formation
from drake_formation.parts.objects.carried import CarriedObject, Mechanics
from drake_formation.parts.objects.grips import GripNumbers, Motion, Pair
from drake_formation.parts.part import Array, Numbers
from drake_formation.parts.registry import part
from drake_formation.systems.scalars import Scalar, cos, largest, sin

GRAVITY = 9.81
"""g (m/s²)."""


@dataclass(frozen=True)
class RigidMechanics(Mechanics):
    """Newton's and Euler's equations of a body in the plane, of state [x, y, φ; ẋ, ẏ, ω].

    Its numbers are [m, J, μ m g, ε, s] (kg, kg m², N, m/s, m), and the grips h in its own frame (m), two a robot.
    """

    def points(self, state: Any, robots: Sequence[int], numbers: Sequence[Any]) -> list[Motion]:
        """Places p = c + R(φ) h, ṗ = ċ + ω × R(φ) h."""
        (x, y, heading, vx, vy, rate), grips = state.tolist(), numbers[1].tolist()
        cosine, sine = cos(heading), sin(heading)
        points = []
        for j in robots:
            ax, ay = _turned(grips[2 * j], grips[2 * j + 1], cosine, sine)
            points.append((x + ax, y + ay, vx - rate * ay, vy + rate * ax))
        return points

    def accelerations(self, state: Any, forces: Sequence[Pair], numbers: Sequence[Any]) -> Any:
        """By m c̈ = Σ f − μ m g ċ/√(‖ċ‖² + ε²), J ω̇ = Σ R(φ) h × f: Coulomb friction, smoothed about rest."""
        body, grips = (group.tolist() for group in numbers)
        (_, _, heading, vx, vy, _), (mass, inertia, friction, slow, _) = state.tolist(), body
        cosine, sine = cos(heading), sin(heading)
        drag = friction / (vx * vx + vy * vy + slow * slow) ** 0.5
        fx, fy, torque = -drag * vx, -drag * vy, 0.0
        for j, (gx, gy) in enumerate(forces):
            ax, ay = _turned(grips[2 * j], grips[2 * j + 1], cosine, sine)
            fx, fy, torque = fx + gx, fy + gy, torque + (ax * gy - ay * gx)
        return np.array([fx / mass, fy / mass, torque / inertia])

    def pose(self, state: Any, numbers: Sequence[Any]) -> Any:  # noqa: ARG002
        """The state itself; the heading counts whole turns."""
        return state

    def strain(self, state: Any, stretches: Sequence[Pair], numbers: Sequence[Any]) -> Any:  # noqa: ARG002
        """The largest stretch of a grip as a share of s, the distance of the farthest grip from the centre."""
        return largest([dx * dx + dy * dy for dx, dy in stretches]) ** 0.5 / numbers[0][4]


def _turned(x: Scalar, y: Scalar, cosine: Scalar, sine: Scalar) -> Pair:
    return cosine * x - sine * y, sine * x + cosine * y


@part("object", kind="rigid")
class Rigid(CarriedObject):
    """A rigid body with mass, inertia and friction with the ground, held at one point by each robot."""

    class Config(GripNumbers):
        """The body, its friction, and its grips; a friction that is more than all grips bear is refused."""

        mass: Positive = Field(default=20.0, description="mass m (kg); chosen: 20")
        inertia: Positive = Field(
            default=10.0,
            description="moment of inertia J (kg m²) about its centre, where the slots' centre is; chosen: 10",
        )
        friction: NonNegative = Field(
            default=0.0,
            description="coefficient μ (1) of its Coulomb friction with the ground, which resists how fast its centre "
            "moves, and no turning; chosen: 0, it is lifted",
        )
        friction_speed: Positive = Field(
            default=0.05,
            description="speed ε (m/s) that smooths friction about rest, μ m g v/√(v² + ε²): far below it the object "
            "creeps; chosen: 0.05",
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether the grips hold against the friction."""
        config, robots = self.config, formation.robots
        if config.grip_strength is None or self.friction_force <= robots * config.grip_strength:
            return
        grips = "1 grip holds" if robots == 1 else f"{robots} grips hold"
        message = (
            f"its friction μ m g = {self.friction_force:.4g} N is more than {grips}, "
            f"{robots} × {config.grip_strength:g} N"
        )
        lightest = robots * config.grip_strength / (config.friction * GRAVITY)
        allowed = f"at most {lightest:.4g} kg, less friction, or stronger grips"
        yield Fault(("mass",), message, shown(config.mass), allowed)

    @property
    def friction_force(self) -> float:
        """μ m g (N)."""
        force: float = self.config.friction * self.config.mass * GRAVITY
        return force

    def mechanics(self, formation: Formation) -> RigidMechanics:  # noqa: ARG002
        """Of a rigid body."""
        return RigidMechanics()

    def own_numbers(self, formation: Formation) -> Numbers:
        """Body, and a grip at every slot."""
        config = self.config
        size = formation.radius or 1.0  # one robot holds it at its centre
        body = np.array([config.mass, config.inertia, self.friction_force, config.friction_speed, size])
        return body, formation.slots.ravel()

    def initial_state(self, formation: Formation, owner: int) -> Array:  # noqa: ARG002
        """At rest with heading 0, its centre where the formation gathers."""
        return np.array([*formation.centre, 0.0, 0.0, 0.0, 0.0])

    def fastest(self, formation: Formation) -> tuple[float, float]:
        """Of a grip between a robot and the body, and of the friction about rest."""
        config = self.config
        lightness = 1.0 / formation.masses.min() + formation.robots / config.mass
        lightness += float((formation.slots**2).sum()) / config.inertia
        slowing = config.friction * GRAVITY / config.friction_speed
        return config.grip_stiffness * lightness, config.grip_damping * lightness + slowing
