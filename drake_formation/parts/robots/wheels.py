"""Omni and mecanum wheels: how a body is pushed and turned by what they exert on the ground.

Such a wheel pushes along one line alone, the axis of the roller on which it stands; across that it rolls freely.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.systems.scalars import Scalar, at_least, lesser

Array = NDArray[np.float64]

SINGULAR = 1e-6
"""A layout whose weakest direction has less than this share of the strongest is taken not to push there at all."""


def wheel_jacobian(mounting: ArrayLike, push: ArrayLike, distance: float) -> Array:
    """What each wheel's force adds to the force and torque on the body (Siegwart et al., 2011, Sec. 3.2.3).

    By virtual work its transpose gives the speed of each wheel along its own line from the body's motion (v_x, v_y, ω).

    Args:
        mounting: β_k, where each of n wheels stands as seen from the centre, from the heading counter-clockwise (rad).
        push: α_k, in which direction it pushes, in the same frame (rad).
        distance: ρ from the centre (m).

    Returns:
        J, shape (3, n), with columns [cos α; sin α; ρ sin(α − β)]: force in the body's frame (1) and torque (m).
    """
    beta, alpha = np.asarray(mounting, dtype=float), np.asarray(push, dtype=float)
    return np.stack([np.cos(alpha), np.sin(alpha), distance * np.sin(alpha - beta)])


def what_is_lacking(mounting: ArrayLike, push: ArrayLike) -> str:
    """What a layout of wheels cannot do, in words; empty where it can push in every direction and turn.

    Args:
        mounting: β_k (rad).
        push: α_k (rad).
    """
    directions, strengths, _ = np.linalg.svd(wheel_jacobian(mounting, push, 1.0))
    rank = int((strengths > SINGULAR * strengths[0]).sum())
    if rank == 3:
        return ""
    x, y, turn = directions[:, 2]
    if rank < 2:
        what = "all wheels do the same"
    elif np.hypot(x, y) < SINGULAR:
        what = "they cannot turn it"
    elif abs(turn) < SINGULAR:
        what = f"they cannot push along {np.degrees(np.arctan2(y, x)) % 180.0:.3g} deg"
    else:
        what = "they cannot push without turning it"
    return f"the wheels' Jacobian has rank {rank}, not 3: {what}"


def wheel_forces(wrench: tuple[Scalar, Scalar, Scalar], inverse: list[Scalar]) -> list[Scalar]:
    """The forces of the wheels that exert a wrench on the body, with the least sum of squares: f = J⁺ w.

    Args:
        wrench: w, force in the body's frame (N) and torque (N m).
        inverse: pseudo-inverse J⁺ row by row, three numbers a wheel.

    Returns:
        f, one number a wheel (N).
    """
    fx, fy, torque = wrench
    rows = zip(inverse[::3], inverse[1::3], inverse[2::3], strict=True)
    return [a * fx + b * fy + c * torque for a, b, c in rows]


def body_wrench(forces: list[Scalar], jacobian: list[Scalar]) -> list[Scalar]:
    """What the wheels exert on the body: w = J f.

    Args:
        forces: f, one number a wheel (N).
        jacobian: J row by row, three rows of as many numbers.

    Returns:
        w, force in the body's frame (N), x and y, and torque (N m).
    """
    count = len(forces)
    rows = (jacobian[k * count : (k + 1) * count] for k in range(3))
    return [sum(a * f for a, f in zip(row, forces, strict=True)) for row in rows]


def wheel_speeds(motion: tuple[Scalar, Scalar, Scalar], jacobian: list[Scalar]) -> list[Scalar]:
    """The speed of each wheel along its own line: w = Jᵀ [v; ω].

    Args:
        motion: velocity in the body's frame (m/s) and turning rate (rad/s).
        jacobian: J row by row, three rows of as many numbers.

    Returns:
        w, one number a wheel (m/s).
    """
    vx, vy, turning = motion
    count = len(jacobian) // 3
    columns = (jacobian[k::count] for k in range(count))
    return [a * vx + b * vy + c * turning for a, b, c in columns]


def within_motor(force: Scalar, speed: Scalar, stall: Scalar, fastest: Scalar) -> Scalar:
    """A force cut to what a direct-current motor can do at a speed, within ±stall and its torque-speed line (N).

    At rest it exerts the stall force either way; the faster the wheel, the less drives it on, and nothing at the
    fastest, as its back EMF says (Siciliano et al., *Robotics*, 2009, Sec. 5.2.1). Braking takes the stall force.

    Args:
        force: asked for (N).
        speed: of the wheel along its line (m/s).
        stall: the force at rest (N).
        fastest: speed at which none is left (m/s).
    """
    most = lesser(stall, stall - stall * speed / fastest)
    least = at_least(-stall - stall * speed / fastest, -stall)
    return at_least(lesser(force, most), least)


def within_limit(force: Scalar, limit: Scalar) -> Scalar:
    """A force cut to what a motor can do (N), of any scalar: between −limit and limit."""
    return at_least(-at_least(-force, -limit), -limit)
