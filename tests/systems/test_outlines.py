"""The laws of shapes in every scalar."""

import numpy as np
from hypothesis import given, settings
from pydrake.autodiffutils import AutoDiffXd
from pydrake.symbolic import Expression, Variable
from shapes import random_obstacle
from strategies import generators

from drake_formation.formation.obstacles import Obstacle, Obstacles
from drake_formation.systems.outlines import offsets

few = settings(max_examples=25)


def random_scene(rng):
    drift = np.array([[0.5, 1.5, 0.3, -0.2], [1.5, 2.0, -1.0, 0.4]])
    moving = [Obstacle(item.vertices, item.radius, motion=drift) for item in (random_obstacle(rng) for _ in range(2))]
    return Obstacles((random_obstacle(rng), *moving))


@few
@given(generators)
def test_every_scalar_gives_the_same_offsets(rng):
    scene = random_scene(rng)
    numbers, (x, y), time = scene.numbers.tolist(), rng.uniform(-4, 4, 2).tolist(), float(rng.uniform(0, 3))
    plain = np.array(list(offsets(x, y, time, numbers, scene.layout)))

    vectors, surfaces = scene.away([[x, y]], [time])
    np.testing.assert_array_equal(np.column_stack([vectors[0], surfaces[0]]), plain)

    values = [x, y, time, *numbers]
    dual = [AutoDiffXd(value, unit) for value, unit in zip(values, np.eye(len(values)), strict=True)]
    found = offsets(*dual[:3], dual[3:], scene.layout)
    np.testing.assert_allclose([[entry.value() for entry in row] for row in found], plain, rtol=0, atol=1e-12)

    variables = [Variable(f"v{k}") for k in range(len(values))]
    symbols = [Expression(variable) for variable in variables]
    environment = dict(zip(variables, values, strict=True))
    found = offsets(*symbols[:3], symbols[3:], scene.layout)
    evaluated = [[(entry + Expression(0.0)).Evaluate(environment) for entry in row] for row in found]
    np.testing.assert_allclose(evaluated, plain, rtol=0, atol=1e-12)


def test_a_polygon_of_one_shape_is_felt_alike_by_whichever_corner_it_begins():
    corners = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.5, 0.4]])
    places = np.random.default_rng(0).uniform(-2, 4, (200, 2))
    turned = [Obstacles((Obstacle(np.roll(corners, k, axis=0), 0.1),)).away(places) for k in range(4)]
    for vectors, surfaces in turned[1:]:
        np.testing.assert_allclose(vectors, turned[0][0], atol=1e-12)
        np.testing.assert_allclose(surfaces, turned[0][1], atol=1e-12)
