"""Grips: how a robot holds an object, at one point and softly."""

from pydantic import Field

from drake_formation.config.values import NonNegative, Positive
from drake_formation.parts.objects.breaking import LookNumbers
from drake_formation.systems.scalars import Scalar

Pair = tuple[Scalar, Scalar]
Motion = tuple[Scalar, Scalar, Scalar, Scalar]
"""Place of a point and its velocity in the world frame, x and y of each (m, m/s)."""


class GripNumbers(LookNumbers):
    """How the robots hold the object."""

    grip_stiffness: Positive = Field(default=1e4, description="stiffness of a grip k_g (N/m); chosen: 1e4")
    grip_damping: NonNegative = Field(default=400.0, description="damping of a grip c_g (N s/m); chosen: 400")
    grip_strength: Positive | None = Field(
        default=None,
        description="force F_g (N) beyond which a grip breaks for good; default: unlimited",
    )


def grip_force(robot: Motion, point: Motion, stiffness: Scalar, damping: Scalar) -> Pair:
    """What an object exerts on a robot through a spring and damper of no length (Kelvin-Voigt).

    f = −k_g (q − p) − c_g (v − ṗ); the robot exerts −f on the object at p. What is lost is c_g ‖v − ṗ‖².

    Args:
        robot: q and v of the robot.
        point: p and ṗ of the point of the object that it holds.
        stiffness: k_g (N/m).
        damping: c_g (N s/m).

    Returns:
        f (N), x and y component.
    """
    (qx, qy, vx, vy), (px, py, wx, wy) = robot, point
    return -(stiffness * (qx - px) + damping * (vx - wx)), -(stiffness * (qy - py) + damping * (vy - wy))
