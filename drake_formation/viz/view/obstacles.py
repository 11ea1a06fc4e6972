"""What obstacles look like: upright over their outline, and flat over where they are sensed."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from pydrake.common import MemoryFile
from pydrake.geometry import Cylinder, InMemoryMesh, Mesh
from pydrake.math import RigidTransform

from drake_formation.formation.obstacles import Obstacle
from drake_formation.viz.obstacles import grown_outline
from drake_formation.viz.view.solids import DARK, Colour, Solid

Array = NDArray[np.float64]

POINT = 0.06
"""Radius at which a point or a wall without one is drawn (m)."""

HEIGHT, THICKNESS = 0.6, 0.01
"""Of an obstacle, and of what shows its range (m)."""

RANGE: Colour = (0.9, 0.6, 0.0, 0.25)


def obstacle_solids(obstacle: Obstacle, sensing_range: float) -> Iterator[Solid]:
    """An obstacle where it is before it moves, and all over which robots sense it, if they do."""
    least = POINT if len(obstacle.vertices) < 3 else 0.0
    yield _upright(obstacle.vertices, max(obstacle.radius, least), HEIGHT, DARK)
    if sensing_range:
        yield _upright(obstacle.vertices, obstacle.radius + sensing_range, THICKNESS, RANGE)


def _upright(vertices: Array, radius: float, height: float, colour: Colour) -> Solid:
    """What stands on the ground over all points within a radius of some vertices (m)."""
    if len(vertices) == 1:
        ((x, y),) = vertices
        return Solid(Cylinder(radius, height), RigidTransform([x, y, height / 2]), colour)
    return Solid(prism(grown_outline(vertices, radius), height), colour=colour)


def prism(outline: Array, height: float) -> Mesh:
    """A prism on the ground over a polygon of any form (m), shape (corners, 2); its last corner is the first."""
    from shapely import Polygon, constrained_delaunay_triangles
    from shapely.geometry.polygon import orient  # slow to import, and most obstacles are circles

    base = orient(Polygon(outline))
    pieces = [np.array(orient(piece).exterior.coords[:3]) for piece in constrained_delaunay_triangles(base).geoms]
    ring = np.array(base.exterior.coords)
    low, high = (np.column_stack([ring, np.full(len(ring), z)]) for z in (0.0, height))
    faces = [
        *(np.column_stack([piece, np.full(3, height)]) for piece in pieces),
        *(np.column_stack([piece[::-1], np.zeros(3)]) for piece in pieces),
        *np.stack([low[:-1], low[1:], high[1:]], axis=1),
        *np.stack([low[:-1], high[1:], high[:-1]], axis=1),
    ]
    corners = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in np.concatenate(faces)]
    triangles = [f"f {k} {k + 1} {k + 2}" for k in range(1, 3 * len(faces), 3)]
    return Mesh(InMemoryMesh(mesh_file=MemoryFile("\n".join([*corners, *triangles, ""]), ".obj", "prism")))
