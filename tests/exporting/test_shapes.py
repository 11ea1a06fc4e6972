"""Solids of SceneGraph keep their size and place where other programs draw them."""

import numpy as np
import pytest
from pydrake.geometry import Box, Capsule, Convex, Cylinder, Sphere
from pydrake.math import RigidTransform, RotationMatrix

from drake_formation.exporting.shapes import pieces
from drake_formation.viz.view.obstacles import prism
from drake_formation.viz.view.solids import Solid

NOTCHED = np.array([[0, 0], [3, 0], [3, 2], [2, 2], [2, 1], [0, 1], [0, 0]], dtype=float)  # 4 m²


def volume(corners):
    """Of what triangles enclose, seen from outside counter-clockwise."""
    a, b, c = corners.reshape(-1, 3, 3).transpose(1, 0, 2)
    return float((a * np.cross(b, c)).sum() / 6)


def test_triangles_enclose_what_the_solid_does():
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], dtype=float)
    for shape, expected in ((prism(NOTCHED, 0.5), 2.0), (Convex(cube.T, "box"), 6.0)):
        (piece,) = pieces([Solid(shape)])
        assert piece.kind == "triangles"
        assert volume(piece.corners) == pytest.approx(expected)


def test_plain_shapes_keep_size_place_and_colour():
    turned = RigidTransform(RotationMatrix.MakeZRotation(np.pi / 2), [1, 2, 3])
    solids = [Solid(Box(1, 2, 3), turned, (1, 0, 0, 1)), Solid(Cylinder(0.5, 2)), Solid(Sphere(0.5))]
    box, cylinder, sphere = pieces(solids, (0, 0, 1, 1))
    assert (box.kind, box.size, box.place, box.colour) == ("cubes", (1, 2, 3), (1, 2, 3), (1, 0, 0, 1))
    assert box.turned == pytest.approx((np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    assert (cylinder.kind, cylinder.size, cylinder.colour) == ("cylinders", (1, 1, 2), (0, 0, 1, 1))
    assert (sphere.kind, sphere.size) == ("spheres", (1, 1, 1))


def test_a_shape_that_nobody_draws_is_refused():
    with pytest.raises(TypeError, match="Capsule"):
        list(pieces([Solid(Capsule(1, 1))]))
