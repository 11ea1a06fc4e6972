import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from drake_formation.formation.obstacles import Obstacle, Obstacles
from drake_formation.viz.obstacles import draw_obstacles, grown

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]])


@pytest.mark.parametrize(("vertices", "radius"), [(SQUARE, 0.3), (SQUARE, 0.0), (SQUARE[:2], 0.2), (SQUARE[:1], 0.5)])
def test_a_patch_is_all_that_is_within_the_radius(vertices, radius):
    path = grown(vertices, radius)
    path = path.get_transform().transform_path(path.get_path())
    places = np.random.default_rng(0).uniform(-1, 3, (400, 2))
    clearance = Obstacles((Obstacle(vertices, radius),)).clearance(places)[:, 0]
    clear = np.abs(clearance) > 0.02  # arcs are drawn by chords
    np.testing.assert_array_equal(path.contains_points(places[clear]), clearance[clear] < 0)


def test_one_that_moves_is_drawn_where_it_was_at_each_time_and_its_range_at_the_last():
    times = np.linspace(0.0, 4.0, 9)
    outline = np.full((9, 1, 1, 2), 1.0)
    outline[:, 0, 0, 0] = times
    result = xr.Dataset(
        {
            "obstacle_position": (("obstacle", "axis"), np.ones((1, 2))),
            "obstacle_radius": (("obstacle",), np.array([0.5])),
            "obstacle_outline": (("time", "obstacle", "vertex", "axis"), outline),
        },
        {"time": times, "obstacle": [1], "axis": ["x", "y"]},
        {"sensing_range_m": 1.0},
    )
    axes = Figure().subplots()
    draw_obstacles(axes, result, [0.0, 2.0, 4.0])
    drawn = [(patch.center[0], patch.radius) for patch in axes.patches if isinstance(patch, Circle)]
    assert drawn == [(4.0, 0.5), (2.0, 0.5), (0.0, 0.5), (4.0, 1.5)]
