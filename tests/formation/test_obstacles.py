"""Distances, by an independent library; and where obstacles are when."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from shapes import random_obstacle, shape_of
from strategies import generators

from drake_formation.formation.obstacles import Obstacle, Obstacles

few = settings(max_examples=40)


@few
@given(generators)
def test_the_clearance_is_the_distance_to_the_shape_and_negative_inside(rng):
    obstacle = random_obstacle(rng)
    places = rng.uniform(-4, 4, (50, 2))
    shape = shape_of(obstacle)
    points = shapely.points(places)
    signed = np.where(shape.contains(points), -shape.boundary.distance(points), shape.distance(points))
    found = Obstacles((obstacle,)).clearance(places)[:, 0]
    np.testing.assert_allclose(found, signed - obstacle.radius, atol=1e-12)


@few
@given(generators)
def test_the_way_out_leads_away_from_the_nearest_point(rng):
    obstacle, place = random_obstacle(rng), rng.uniform(-4, 4, 2)
    (vector,), (surface,) = Obstacles((obstacle,)).away(place)
    step = 1e-6 * vector / np.linalg.norm(vector)
    before, after = Obstacles((obstacle,)).clearance(np.array([place - step, place + step]))[:, 0]
    assert after - before == pytest.approx(2e-6, rel=1e-3)
    assert Obstacles((obstacle,)).clearance(place)[0] == pytest.approx(np.hypot(*vector) - surface)


def test_an_obstacle_goes_from_place_to_place_and_rests():
    motion = np.array([[1.0, 3.0, 0.5, 0.0], [3.0, 4.0, 0.0, -2.0]])
    obstacle = Obstacle(np.array([[2.0, 2.0]]), 0.5, motion=motion)
    moved = obstacle.displacement([0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 9.0])
    np.testing.assert_allclose(moved, [[0, 0], [0, 0], [0.5, 0], [1, 0], [1, -1], [1, -2], [1, -2]])
    obstacles = Obstacles((obstacle,))
    assert obstacles.turns.tolist() == [1.0, 3.0, 4.0]
    np.testing.assert_allclose(obstacles.clearance([[2.0, 2.0], [3.0, 0.0]], [0.0, 9.0])[:, 0], -0.5)
    np.testing.assert_allclose(obstacles.outlines(np.array([0.0, 9.0]))[:, 0, 0], [[2, 2], [3, 0]])


def test_a_notch_makes_a_polygon_not_convex():
    corner = np.array([[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]], dtype=float)
    assert not Obstacle(corner).is_convex
    assert Obstacle(corner[:4]).is_convex
    assert Obstacle(corner[:1]).is_convex
