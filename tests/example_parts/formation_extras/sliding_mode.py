"""A sliding-mode controller with a boundary layer."""

import numpy as np
from pydantic import Field

from drake_formation.config.values import Positive, Section
from drake_formation.parts import Part, part
from drake_formation.parts.tracking.controller import TrackingController


def sliding_force(error, acceleration, numbers):
    """−K s/√(‖s‖² + φ²) on the surface s = ė + λ e, smooth so that it can be linearized and compiled."""
    ex, ey, evx, evy = error
    gain, slope, layer = numbers
    sx, sy = evx + slope * ex, evy + slope * ey
    push = gain / (sx * sx + sy * sy + layer * layer) ** 0.5
    return -push * sx, -push * sy


@part("tracking", kind="sliding_mode")
class SlidingMode(Part):
    """Drives the tracking error to a surface on which it decays, with a force of bounded size."""

    class Config(Section):
        """Its numbers."""

        gain: Positive = Field(default=100.0, description="largest force K (N)")
        slope: Positive = Field(default=0.5, description="rate λ at which the error decays on the surface (1/s)")
        layer: Positive = Field(default=0.2, description="width φ of the boundary layer (m/s)")

    def numbers(self, formation, owner):
        """The configured ones, and the slot."""
        config = self.config
        return np.array([config.gain, config.slope, config.layer]), formation.slots[owner]

    def block(self, formation, owner, numbers):
        """The project's own block for laws of the tracking error."""
        *groups, slot = numbers
        return TrackingController(sliding_force, groups, slot)
