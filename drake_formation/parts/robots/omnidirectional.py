"""A robot on omni or mecanum wheels: it moves as a point mass does, while it keeps a heading of its own."""

import functools
import math
from collections.abc import Iterator
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydrake.systems.controllers import LinearQuadraticRegulator

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import Gap, NonNegative, Positive
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.parts.robots.plant import Pair
from drake_formation.parts.robots.robot import Robot, RobotNumbers
from drake_formation.parts.robots.wheels import (
    body_wrench,
    what_is_lacking,
    wheel_forces,
    wheel_jacobian,
    wheel_speeds,
    within_limit,
    within_motor,
)
from drake_formation.systems.scalars import Scalar, cos, sin

Array = NDArray[np.float64]
Angles = Annotated[tuple[float, ...], Field(strict=False)]
"""An angle for each wheel (deg)."""
HeadingCost = Annotated[tuple[Positive, NonNegative], Field(strict=False)]
"""Weights of a heading's error and of its rate."""


def omnidirectional_motion(
    inner: list[Scalar],
    velocity: Pair,
    control: Pair,
    spring: Pair,
    body: list[Scalar],
    steering: list[Scalar],
    jacobian: list[Scalar],
    inverse: list[Scalar],
    *limits: list[Scalar],
) -> tuple[Scalar, ...]:
    """How a body on wheels moves that holds the object at its centre.

    The control u, turned into the body's frame, and the torque τ = −k (φ − φ_r) − d φ̇ are exerted by the wheels:
    f = J⁺ [Rᵀu; τ], each cut to its limits. Then m v̇ = R (J f)_xy + s and J_z φ̈ = (J f)_τ. Without a limit J J⁺ = I,
    and the centre moves as the point mass does, whatever the heading.

    Args:
        inner: heading φ (rad) and its rate (rad/s).
        velocity: of the centre, in the world frame (m/s).
        control: u, in the world frame (N).
        spring: what the object exerts, s (N).
        body: m (kg) and J_z (kg m²).
        steering: φ_r (rad), k (N m/rad) and d (N m s/rad).
        jacobian: J of the wheels, row by row.
        inverse: its pseudo-inverse J⁺, row by row.
        limits: the largest force of a wheel (N) and, where it is limited, its largest speed (m/s); nothing for none.

    Returns:
        v̇ (m/s²), x and y; the heading's rate (rad/s) and its rate (rad/s²).
    """
    (heading, rate), (mass, inertia), (kept, stiffness, damping) = inner, body, steering
    (ux, uy), (sx, sy) = control, spring
    c, s = cos(heading), sin(heading)
    torque = -(stiffness * (heading - kept) + damping * rate)
    forces = wheel_forces((c * ux + s * uy, c * uy - s * ux, torque), inverse)
    for largest, *fastest in limits:
        if fastest:
            vx, vy = velocity
            speeds = wheel_speeds((c * vx + s * vy, c * vy - s * vx, rate), jacobian)
            forces = [within_motor(f, w, largest, *fastest) for f, w in zip(forces, speeds, strict=True)]
        else:
            forces = [within_limit(force, largest) for force in forces]
    fx, fy, turn = body_wrench(forces, jacobian)
    return (c * fx - s * fy + sx) / mass, (s * fx + c * fy + sy) / mass, rate, turn / inertia


@functools.lru_cache(maxsize=1024)
def heading_gain(inertia: float, state_cost: tuple[float, float], input_cost: float) -> tuple[float, float]:
    """Gain of the LQR that keeps a heading, J_z φ̈ = τ, from Drake's ``LinearQuadraticRegulator``.

    Args:
        inertia: J_z (kg m²).
        state_cost: weights of the heading's error and of its rate.
        input_cost: weight of the torque.

    Returns:
        k (N m/rad) and d (N m s/rad) of τ = −k (φ − φ_r) − d φ̇; not a number where Drake finds none.
    """
    a, b = np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0 / inertia]])
    try:
        gain, _ = LinearQuadraticRegulator(a, b, np.diag(state_cost), np.array([[input_cost]]))
    except (RuntimeError, SystemExit):  # SystemExit is how Drake reports a failed demand
        return math.nan, math.nan
    k, d = gain.ravel().tolist()
    return k, d


@part("robot", kind="omnidirectional")
class Omnidirectional(Robot):
    """A body on three or four omni or mecanum wheels, pushed in any direction; it keeps its heading by an LQR."""

    class Config(RobotNumbers):
        """Its body, its wheels, and how it keeps its heading."""

        inertia: Positive = Field(default=2.0, description="moment of inertia J_z (kg m²) about its centre; chosen: 2")
        heading: float = Field(
            default=0.0, description="heading at the start φ (deg), from +x counter-clockwise; chosen: 0"
        )
        kept_heading: float | None = Field(
            default=None, description="heading to keep φ_r (deg), from +x counter-clockwise; default: that at the start"
        )
        heading_cost: HeadingCost = Field(
            default=(1.0, 1.0), description="costs of the heading's error (1/rad²) and of its rate (s²/rad²); chosen: 1"
        )
        torque_cost: Positive = Field(default=1.0, description="cost of the torque (1/(N² m²)); chosen: 1")
        wheel_angles: Angles = Field(
            default=(0.0, 120.0, 240.0),
            description="where each wheel stands β_k (deg), as seen from the centre, from the heading "
            "counter-clockwise; three or four; chosen: [0, 120, 240]",
        )
        push_angles: Angles | None = Field(
            default=None,
            description="in which direction each wheel pushes α_k (deg), from the heading counter-clockwise; default: "
            "β_k + 90, as omni wheels do; mecanum wheels at [45, 135, 225, 315]: [-45, 45, -45, 45]",
        )
        wheel_distance: Gap = Field(
            default=0.3, description="distance of the wheels ρ (m) from the centre; chosen: 0.3"
        )
        wheel_force_limit: Positive | None = Field(
            default=None, description="largest force of a wheel (N); default: unlimited"
        )
        wheel_speed_limit: Positive | None = Field(
            default=None,
            description="largest speed of a wheel along its line (m/s), up to which the force that drives it on falls "
            "from wheel_force_limit to 0; default: unlimited",
        )

    dynamics = staticmethod(omnidirectional_motion)
    has_heading = True

    @property
    def angles(self) -> tuple[Array, Array]:
        """Where each wheel stands and in which direction it pushes, in the body's frame (rad)."""
        mounting = np.radians(self.config.wheel_angles)
        push = self.config.push_angles
        return mounting, mounting + 0.5 * np.pi if push is None else np.radians(push)

    @property
    def kept(self) -> float:
        """The heading to keep (rad)."""
        config = self.config
        return math.radians(config.heading if config.kept_heading is None else config.kept_heading)

    @property
    def gain(self) -> tuple[float, float]:
        """Of the heading; see :func:`heading_gain`."""
        return heading_gain(self.config.inertia, self.config.heading_cost, self.config.torque_cost)

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether the wheels can push in every direction and turn it, and whether its heading can be kept."""
        wheels, push = self.config.wheel_angles, self.config.push_angles
        if len(wheels) not in (3, 4):
            yield Fault(("wheel_angles",), f"{len(wheels)} wheels", shown(wheels), "three or four angles (deg)")
        elif push is not None and len(push) != len(wheels):
            message = f"{len(push)} directions for {len(wheels)} wheels"
            yield Fault(("push_angles",), message, shown(push), f"{len(wheels)} angles (deg), one a wheel")
        elif lacking := what_is_lacking(*self.angles):
            key, value = ("wheel_angles", wheels) if push is None else ("push_angles", push)
            yield Fault((key,), lacking, shown(value), "a layout that pushes in every direction and turns")
        if self.config.wheel_speed_limit is not None and self.config.wheel_force_limit is None:
            message, limit = "how hard the wheels push at rest is not said", self.config.wheel_speed_limit
            yield Fault(("wheel_speed_limit",), message, shown(limit), "also wheel_force_limit (N)")
        if not np.isfinite(self.gain).all():
            message = f"Drake finds no gain for a moment of inertia of {self.config.inertia:g} kg m²"
            yield Fault(
                ("heading_cost",), message, shown(self.config.heading_cost), "costs and inertia of less different sizes"
            )

    def own_numbers(self) -> Numbers:
        """Body, steering, the wheels' Jacobian and its pseudo-inverse, and the wheels' limits where there are any."""
        config = self.config
        jacobian = wheel_jacobian(*self.angles, config.wheel_distance)
        body, steering = np.array([config.mass, config.inertia]), np.array([self.kept, *self.gain])
        given = [limit for limit in (config.wheel_force_limit, config.wheel_speed_limit) if limit is not None]
        limits = (np.array(given),) if given else ()
        return body, steering, jacobian.ravel(), np.linalg.pinv(jacobian).ravel(), *limits

    def inner_state(self) -> Array:
        """The heading, no further from that to keep than half a turn, and no rate."""
        away = math.remainder(math.radians(self.config.heading) - self.kept, math.tau)
        return np.array([self.kept + away, 0.0])
