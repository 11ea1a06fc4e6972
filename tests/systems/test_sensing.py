import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from strategies import generators

from drake_formation.systems.sensing import NearestSensing, nearest


@given(st.lists(st.floats(0, 1e6), min_size=1, max_size=6, unique=True))
def test_exactly_the_nearest_robot_sees_an_obstacle(distances):
    sees = [nearest(distances, robot) for robot in range(len(distances))]
    assert sees == [float(distance == min(distances)) for distance in distances]


def test_robots_at_the_same_distance_both_see_it():
    assert [nearest([1.0, 2.0, 1.0], robot) for robot in range(3)] == [1, 0, 1]


def test_a_single_robot_sees_everything():
    assert nearest([7.0], 0) == 1


@given(st.integers(1, 5), st.integers(0, 3), generators)
def test_the_block_gives_each_obstacle_to_its_nearest_robot(robots, obstacles, rng):
    states, centres = rng.uniform(-5, 5, (robots, 4)), rng.uniform(-5, 5, (obstacles, 2))
    block = NearestSensing(robots, np.column_stack([centres, np.zeros(obstacles)]))
    context = block.CreateDefaultContext()
    for i, state in enumerate(states):
        block.GetInputPort(f"state_{i + 1}").FixValue(context, state)
    sensed = np.array([block.GetOutputPort(f"sensed_{i + 1}").Eval(context) for i in range(robots)])
    distances = np.linalg.norm(states[:, None, :2] - centres, axis=2)
    np.testing.assert_array_equal(sensed, np.arange(robots)[:, None] == distances.argmin(axis=0))
