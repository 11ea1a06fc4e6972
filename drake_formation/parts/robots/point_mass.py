"""A robot as a mass in the plane, held to its neighbours by the carried object (paper, Eqs. 2-7)."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field

from drake_formation.config.values import NonNegative
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, SpringLaw
from drake_formation.parts.registry import part
from drake_formation.parts.robots.plant import Pair, PlanarRobot
from drake_formation.parts.robots.robot import Robot, RobotNumbers, held_robots, options
from drake_formation.systems.scalars import Scalar


def free_mass(_inner: list[Scalar], _velocity: Pair, control: Pair, spring: Pair, mass: list[Scalar]) -> Pair:
    """Acceleration of a mass under the forces on it: m v̇ = u + s (paper, Eq. 3).

    Args:
        control: u, in the world frame (N).
        spring: what the object exerts, s (N).
        mass: m (kg), one number.

    Returns:
        v̇ (m/s²), x and y component.
    """
    (m,), (ux, uy), (sx, sy) = mass, control, spring
    return (ux + sx) / m, (uy + sy) / m


def dragged_mass(
    _inner: list[Scalar], velocity: Pair, control: Pair, spring: Pair, mass: list[Scalar], drag: list[Scalar]
) -> Pair:
    """Acceleration of a mass that viscous friction slows down: m v̇ = u + s − b v.

    Rolling resistance and the back EMF of the drives act so (Siciliano et al., *Robotics*, 2009, Sec. 5.2.1).

    Args:
        velocity: v, in the world frame (m/s).
        control: u (N).
        spring: what the object exerts, s (N).
        mass: m (kg), one number.
        drag: b (N s/m), one number.

    Returns:
        v̇ (m/s²), x and y component.
    """
    (m,), (b,), (vx, vy), (ux, uy), (sx, sy) = mass, drag, velocity, control, spring
    return (ux + sx - b * vx) / m, (uy + sy - b * vy) / m


def RobotPlant(  # noqa: N802 - makes a block, as its class would
    neighbours: Sequence[int],
    law: type[SpringLaw],
    mass: ArrayLike,
    springs: ArrayLike,
    initial_state: ArrayLike,
    *,
    may_fail: bool = False,
    **options: Any,
) -> Any:
    """The plant of a free mass, whose acceleration is the forces on it by its mass unless it fails.

    Args:
        neighbours: numbers of the physically coupled robots (from 1), which name the spring ports.
        law: how a spring acts.
        mass: m_i (kg), shape (1,).
        springs: numbers of the law and displacement of each spring, shape (neighbours, numbers + 2).
        initial_state: default state [q; v], shape (4,).
        may_fail: whether its drives may fail and its brakes lock.
        options: further ones of :class:`drake_formation.parts.robots.plant.PlanarRobot`.
    """
    failing = {"acceleration": may_fail, "may_fail": may_fail}
    return PlanarRobot(free_mass, neighbours, law, [mass], springs, initial_state, **failing, **options)


@part("robot", kind="point_mass")
class PointMass(Robot):
    """A point mass, pushed in any direction (paper, Eq. 3)."""

    class Config(RobotNumbers):
        """Its mass, and what slows it down."""

        drag: NonNegative = Field(
            default=0.0, description="viscous drag b_i (N s/m), one for all or one a robot; published: none"
        )

    dynamics = staticmethod(dragged_mass)
    may_fail = True

    def own_numbers(self) -> Numbers:
        """The mass, and the drag where there is any."""
        mass, drag = np.array([self.config.mass]), np.array([self.config.drag])
        return (mass, drag) if self.config.drag else (mass,)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The plant; without drag it needs no port to tell its acceleration."""
        if self.config.drag:
            return super().block(formation, owner, numbers)
        mass, springs = numbers
        start = self.initial_state(formation, owner)
        neighbours = held_robots(formation, owner)
        return RobotPlant(neighbours, formation.law, mass, springs, start, **options(formation, owner))
