"""Solids of SceneGraph as what other programs draw: boxes, cylinders, ellipsoids, and else triangles."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from pydrake.geometry import Box, Convex, Cylinder, Mesh, Shape, Sphere

from drake_formation.viz.view.solids import Colour, Solid

Array = NDArray[np.float64]
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Piece:
    """A shape in a frame.

    Attributes:
        kind: ``cubes``, ``spheres``, ``cylinders`` (along z) or ``triangles``.
        size: along its axes (m); of triangles nothing.
        place: in the frame (m).
        turned: against the frame, as a quaternion, its real part first.
        colour: its own.
        corners: of triangles, three by three (m), shape (3 n, 3).
    """

    kind: str
    size: Vector
    place: Vector
    turned: tuple[float, float, float, float]
    colour: Colour
    corners: Array = field(default_factory=lambda: np.zeros((0, 3)))


def pieces(solids: Iterable[Solid], colour: Colour = (0.0, 0.0, 0.0, 1.0)) -> Iterator[Piece]:
    """Solids as pieces; those without a colour have the given one."""
    for solid in solids:
        kind, size, corners = _drawn(solid.shape)
        turned = solid.pose.rotation().ToQuaternion().wxyz().tolist()
        place = solid.pose.translation().tolist()
        yield Piece(kind, size, tuple(place), tuple(turned), solid.colour or colour, corners)


def _drawn(shape: Shape) -> tuple[str, Vector, Array]:
    """Kind, size and corners of a shape.

    Raises:
        TypeError: nobody has said how it is drawn.
    """
    none = np.zeros((0, 3))
    match shape:
        case Box():
            return "cubes", tuple(shape.size()), none
        case Sphere():
            return "spheres", (2 * shape.radius(),) * 3, none
        case Cylinder():
            return "cylinders", (2 * shape.radius(), 2 * shape.radius(), shape.length()), none
        case Convex():
            return "triangles", (0.0, 0.0, 0.0), _hull_corners(shape)
        case Mesh():
            return "triangles", (0.0, 0.0, 0.0), _mesh_corners(shape)
    raise TypeError(f"nobody has said how a {type(shape).__name__} is drawn")


def _hull_corners(shape: Convex) -> Array:
    hull = shape.GetConvexHull()
    faces = [hull.element(k) for k in range(hull.num_faces())]
    rims = [[face.vertex(i) for i in range(face.num_vertices())] for face in faces]
    fans = [(rim[0], *pair) for rim in rims for pair in pairwise(rim[1:])]
    return np.array([hull.vertex(int(corner)) for fan in fans for corner in fan]).reshape(-1, 3)


def _mesh_corners(shape: Mesh) -> Array:
    """Corners of a mesh whose file, a Wavefront OBJ, is in memory."""
    text = shape.source().in_memory().mesh_file.contents()
    lines = (text.decode() if isinstance(text, bytes) else text).splitlines()
    vertices = np.array([line.split()[1:] for line in lines if line.startswith("v ")], dtype=float)
    faces = np.array([line.split()[1:] for line in lines if line.startswith("f ")], dtype=int)
    corners: Array = vertices[faces.ravel() - 1]
    return corners
