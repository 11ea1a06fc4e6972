"""What a rigid object looks like; what is made of springs is drawn as links are."""

from collections.abc import Iterator

import numpy as np
from pydrake.geometry import Convex

from drake_formation.formation.formation import Formation
from drake_formation.viz.outline import rigid_outline
from drake_formation.viz.view.solids import CARRYING_HEIGHT, Solid

THICKNESS = 0.05
"""Of a rigid object (m)."""


def object_solids(formation: Formation) -> Iterator[Solid]:
    """A rigid object in its own frame: a plate over its grips, which are at the slots."""
    outline = rigid_outline(formation)
    levels = (CARRYING_HEIGHT, CARRYING_HEIGHT + THICKNESS)
    corners = np.concatenate([np.column_stack([outline, np.full(len(outline), z)]) for z in levels])
    yield Solid(Convex(corners.T, "object"), colour=(0.85, 0.75, 0.55, 0.85))
