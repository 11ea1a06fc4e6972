"""Obstacles of every shape for tests, and what an independent library makes of them."""

import numpy as np
import shapely

from drake_formation.formation.obstacles import Obstacle


def random_obstacle(rng, most=7):
    """A circle, a segment, or a star-shaped polygon, counter-clockwise, with notches or without."""
    count = int(rng.integers(1, most))
    centre, radius = rng.uniform(-2, 2, 2), float(rng.choice([0.0, 0.2]))
    if count < 3:
        return Obstacle(centre + rng.uniform(-1.5, 1.5, (count, 2)), radius)
    angles = 2 * np.pi * (np.arange(count) + rng.uniform(0, 0.6, count)) / count
    reach = rng.uniform(0.4, 1.5, count)[:, None]
    return Obstacle(centre + reach * np.column_stack([np.cos(angles), np.sin(angles)]), radius)


def shape_of(obstacle, time=0.0):
    """An obstacle without its radius, by shapely."""
    vertices = obstacle.outline(time)
    if len(vertices) == 1:
        return shapely.Point(vertices[0])
    return shapely.LineString(vertices) if len(vertices) == 2 else shapely.Polygon(vertices)
