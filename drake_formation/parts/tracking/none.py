"""No local controller: the robot's tracking error is observed, and nothing done about it."""

from typing import Any

from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.controller import TrackingController
from drake_formation.systems.scalars import Scalar


def no_force(
    error: tuple[Scalar, Scalar, Scalar, Scalar],
    acceleration: list[Scalar],  # noqa: ARG001 - what a law of the tracking error takes
) -> tuple[Scalar, Scalar]:
    """No force (N), in the scalar of the error.

    Args:
        error: tracking error ε = x − x_r (m, m/s).
        acceleration: of the reference (m/s²).
    """
    ex, ey, _, _ = error
    return 0.0 * ex, 0.0 * ey


@part("tracking", kind="none")
class NoTracking(Part):
    """No local control, where coordination alone drives the robot; its tracking error is still recorded."""

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The slot."""
        return (formation.slots[owner],)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The controller."""
        (slot,) = numbers
        return TrackingController(no_force, [], slot)
