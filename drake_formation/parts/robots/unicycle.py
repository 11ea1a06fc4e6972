"""A robot with differential drive, which holds the object ahead of its axle and so can push it in any direction."""

import math

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drake_formation.config.values import Gap, Positive
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.parts.robots.plant import Pair
from drake_formation.parts.robots.robot import Robot, RobotNumbers
from drake_formation.parts.robots.wheels import within_limit
from drake_formation.systems.scalars import Scalar, cos, sin

Array = NDArray[np.float64]


def linearizing_drive(
    forward: Scalar, turning: Scalar, control: Pair, spring: Pair, body: list[Scalar]
) -> tuple[Scalar, Scalar]:
    """Drive force and torque by which the held point moves as a point mass: input-output linearization.

    With v forward and ω turning, the held point has the acceleration [v̇ − L ω²; v ω + L ω̇] along the heading and
    across it, while m v̇ = F + s_x and J_z ω̇ = τ + L s_y. The F and τ returned make that (u + s)/m. They take the
    object's force across the heading, which the robot measures where it holds it; with J_z = m L² they would not.
    Siciliano, Sciavicco, Villani & Oriolo, *Robotics* (2009), Sec. 11.6.1, for a robot moved by its speeds.

    Args:
        forward: v, speed of the axle's centre (m/s).
        turning: ω (rad/s).
        control: u, along the heading and across it (N).
        spring: what the object exerts, s, likewise (N).
        body: m (kg), J_z about the axle's centre (kg m²) and L (m).

    Returns:
        F (N) and τ (N m).
    """
    (mass, inertia, ahead), (ux, uy), (_, sy) = body, control, spring
    drive = ux + mass * ahead * turning * turning
    torque = inertia * ((uy + sy) / mass - forward * turning) / ahead - ahead * sy
    return drive, torque


def unicycle_motion(
    inner: list[Scalar], velocity: Pair, control: Pair, spring: Pair, body: list[Scalar], *wheels: list[Scalar]
) -> tuple[Scalar, ...]:
    """How the point moves by which a robot with differential drive holds the object.

    Its centre of mass is the middle of its axle, L behind that point, and moves along the heading θ alone: of the held
    point's velocity, what is along the heading drives it forward and what is across turns it, L θ̇. The heading is left
    to itself; where the point is drawn forward it falls in behind, as a trailer does.

    Args:
        inner: heading θ (rad).
        velocity: of the held point, in the world frame (m/s).
        control: u (N).
        spring: what the object exerts, s (N).
        body: m (kg), J_z about the axle's centre (kg m²) and L (m).
        wheels: distance b between the wheels (m) and the largest force of a wheel (N); nothing for no limit.

    Returns:
        Acceleration of the held point (m/s²), x and y, and θ̇ (rad/s).
    """
    (heading,), (mass, inertia, ahead) = inner, body
    c, s = cos(heading), sin(heading)

    def in_body(vector: Pair) -> Pair:
        x, y = vector
        return c * x + s * y, c * y - s * x

    (forward, sideways), own_control, own_spring = in_body(velocity), in_body(control), in_body(spring)
    turning = sideways / ahead
    drive, torque = linearizing_drive(forward, turning, own_control, own_spring, body)
    for track, limit in wheels:
        right = within_limit(0.5 * drive + torque / track, limit)
        left = within_limit(0.5 * drive - torque / track, limit)
        drive, torque = right + left, 0.5 * track * (right - left)
    along = (drive + own_spring[0]) / mass - ahead * turning * turning
    across = forward * turning + ahead * (torque + ahead * own_spring[1]) / inertia
    return c * along - s * across, s * along + c * across, turning


@part("robot", kind="unicycle")
class Unicycle(Robot):
    """Differential drive that holds the object ahead of its axle; linearized about that point, the heading is free."""

    class Config(RobotNumbers):
        """Its body, its heading, and its wheels."""

        inertia: Positive = Field(
            default=2.0, description="moment of inertia J_z (kg m²) about its axle's centre; chosen: 2"
        )
        heading: float = Field(
            default=0.0, description="heading at the start θ (deg), from +x counter-clockwise; chosen: 0"
        )
        ahead: Gap = Field(
            default=0.3,
            description="distance L (m) of the held point ahead of the axle; on the axle (0) it could not be moved "
            "sideways; chosen: 0.3",
        )
        track: Gap = Field(default=0.5, description="distance b (m) between its two wheels; chosen: 0.5")
        wheel_force_limit: Positive | None = Field(
            default=None, description="largest force of a wheel (N); default: unlimited"
        )

    dynamics = staticmethod(unicycle_motion)
    has_heading = True

    def own_numbers(self) -> Numbers:
        """Body, and the wheels where they are limited."""
        config = self.config
        body = np.array([config.mass, config.inertia, config.ahead])
        if config.wheel_force_limit is None:
            return (body,)
        return body, np.array([config.track, config.wheel_force_limit])

    def inner_state(self) -> Array:
        """The heading."""
        return np.array([math.radians(self.config.heading)])
