"""Avoidance by a field that turns about obstacles, so that a robot is led past what it heads straight for."""

from typing import Any

import numpy as np
from pydantic import Field

from drake_formation.formation.formation import Formation
from drake_formation.parts.avoidance.khatib import avoidance_force, field_block
from drake_formation.parts.avoidance.sensed_field import FieldConfig, SensedField
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.systems.scalars import Scalar


def rotational_force(
    dx: Scalar, dy: Scalar, radius: Scalar, sensing_range: Scalar, cosine: Scalar, sine: Scalar, gain: Scalar
) -> tuple[Scalar, Scalar]:
    """Khatib's force of one obstacle, turned by an angle θ (De Medio & Oriolo 1991: vortex fields, θ = ±90°).

    At 90° it is the vortex field ±(∂U/∂y, −∂U/∂x) of Khatib's potential U, which leads round the obstacle and does not
    push away from it; below, part of the push remains, and grows beyond all bounds towards the surface. It still
    balances somewhere what draws a robot to its goal, but beside the line to the goal, and at a saddle where the goal
    is farther off than the obstacle.

    Args:
        dx: position of the robot relative to the obstacle's centre (m), x component.
        dy: its y component (m).
        radius: radius of the obstacle (m).
        sensing_range: ρ0 (m).
        cosine: cos θ.
        sine: sin θ; above 0 it leads round the obstacle counter-clockwise.
        gain: η (N m²).

    Returns:
        Components of the force on the robot (N).
    """
    fx, fy = avoidance_force(dx, dy, radius, sensing_range, gain)
    return cosine * fx - sine * fy, sine * fx + cosine * fy


@part("avoidance", kind="rotational")
class Rotational(SensedField):
    """A vortex field, which leads round obstacles and has no trap dead ahead of them."""

    class Config(FieldConfig):
        """Range and strength of the field, who feels it, and how far it turns."""

        angle: float = Field(
            default=60.0,
            ge=-90.0,
            le=90.0,
            description="angle θ (deg) by which the repulsive force is turned, counter-clockwise round the obstacle; 0 "
            "is khatib, 90 a vortex that does not push away; chosen: 60",
        )

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The field's range, direction and gain, the obstacles, and what it knows of robots."""
        angle = np.deg2rad(self.config.angle)
        field = np.array([self.config.range, np.cos(angle), np.sin(angle), self.config.gain])
        return field, self.felt(formation, owner).numbers, *self.of_robots(formation, owner)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        return field_block(self, formation, owner, numbers, rotational_force)
