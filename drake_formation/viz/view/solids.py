"""Rigid pieces of what is seen."""

from dataclasses import dataclass, field

from matplotlib.colors import to_rgba
from pydrake.geometry import Shape
from pydrake.math import RigidTransform

Colour = tuple[float, float, float, float]
"""Red, green, blue and how opaque, from 0 to 1."""


def opaque(colour: str, share: float = 1.0) -> Colour:
    """A colour of :mod:`drake_formation.viz.palette`, and how opaque it is."""
    return to_rgba(colour, share)


DARK: Colour = (0.2, 0.2, 0.22, 1.0)

CARRYING_HEIGHT = 0.22
"""At which robots hold the object (m)."""

TALKING_HEIGHT = 0.5
"""At which their antennas are (m)."""


@dataclass(frozen=True)
class Solid:
    """A shape in a frame.

    Attributes:
        shape: as SceneGraph knows it.
        pose: of the shape in the frame.
        colour: its own; None for the colour of the robot it belongs to.
    """

    shape: Shape
    pose: RigidTransform = field(default_factory=RigidTransform)
    colour: Colour | None = None
