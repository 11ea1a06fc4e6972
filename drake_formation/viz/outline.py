"""The outline of a rigid object."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from drake_formation.formation.formation import Formation

Array = NDArray[np.float64]

RIM = 0.12
"""How far it reaches beyond its grips (m)."""


def rigid_outline(formation: Formation) -> Array:
    """Corners of a plate that reaches around its grips, which are at the slots, in its own frame (m), shape (…, 2)."""
    around = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
    rim = RIM * np.stack([np.cos(around), np.sin(around)], axis=-1)
    reached = (formation.slots[:, None] + rim).reshape(-1, 2)
    corners: Array = reached[ConvexHull(reached).vertices]
    return corners
