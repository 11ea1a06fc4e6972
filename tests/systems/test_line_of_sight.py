"""What hides an obstacle, by an independent library; and the block."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from shapes import random_obstacle, shape_of
from strategies import generators

from drake_formation import ScenarioError, load_scenario, simulate
from drake_formation.formation.obstacles import Obstacle, Obstacles
from drake_formation.systems.line_of_sight import LineOfSight
from drake_formation.systems.sight_law import LOOK, look


def expected(robot, positions, footprints, obstacles):
    """1 for each obstacle whose nearest point nothing hides."""
    own, found = shapely.Point(positions[robot]), []
    shapes = [shape_of(item) for item in obstacles]
    for shape in shapes:
        sight = shapely.shortest_line(own, shape)
        others = [i for i in range(len(positions)) if i != robot]
        hidden = any(sight.distance(shapely.Point(positions[i])) < footprints[i] for i in others)
        for other, item in zip(shapes, obstacles, strict=True):
            if other is not shape:
                apart = sight.distance(other)
                hidden |= apart < item.radius or (apart == 0 and len(item.vertices) > 1)
        found.append(float(not hidden))
    return found


def outside(rng, obstacles):
    """A place outside all shapes."""
    while True:
        place = rng.uniform(-5, 5, 2)
        if (obstacles.clearance(place) > 0).all():
            return place


@settings(max_examples=60)
@given(generators)
def test_it_is_what_the_library_says(rng):
    obstacles = Obstacles(tuple(random_obstacle(rng) for _ in range(3)))
    positions = np.array([outside(rng, obstacles) for _ in range(3)])
    footprints = rng.choice([0.0, 0.3], 3)
    inputs = np.column_stack([positions, np.ones((3, 2))]).ravel()
    numbers = np.concatenate([obstacles.numbers, footprints, np.ravel(obstacles.layout).astype(float)])
    found, compiled = np.full(9, 0.5), np.full(9, 0.5)
    look(0.0, inputs, found, numbers)
    LOOK(0.0, inputs, compiled, numbers)
    assert found.reshape(3, 3).tolist() == [expected(i, positions, footprints, obstacles) for i in range(3)]
    np.testing.assert_array_equal(compiled, found)


WALL = Obstacle(np.array([[1.0, -1.0], [1.0, 1.0]]), motion=np.array([[0.0, 10.0, 0.0, 1.0]]))
BEHIND = Obstacle(np.array([[2.0, 0.0]]), 0.1)


def test_the_block_looks_at_the_time_of_its_update():
    obstacles = Obstacles((BEHIND, WALL))
    block = LineOfSight(obstacles.numbers, [0.0, 0.0], obstacles.layout)
    context = block.CreateDefaultContext()
    for port, x in (("state_1", 0.0), ("state_2", 1.5)):
        block.GetInputPort(port).FixValue(context, [x, 0.0, 0.0, 0.0])

    def seen(time):
        context.SetTime(time)
        context.SetDiscreteState(block.EvalUniquePeriodicDiscreteUpdate(context))
        return [block.GetOutputPort(f"visible_{i}").Eval(context).tolist() for i in (1, 2)]

    assert seen(0.0) == [[0.0, 1.0], [1.0, 1.0]]
    assert seen(2.0) == [[1.0, 1.0], [1.0, 1.0]]


HIDDEN = {
    "aggregation.duration": 0.0,
    "robots.start": {"centre": [5.0, 3.0]},
    "transport": {"goal": [12.0, 3.0], "duration": 5.0},
    "avoidance.obstacles": [
        {"kind": "segment", "ends": [[3.0, 4.2], [9.0, 4.2]]},
        {"kind": "polygon", "vertices": [[5.0, 4.25], [7.0, 4.25], [7.0, 4.6], [5.0, 4.6]]},
    ],
}


def forces(**changes):
    return np.abs(simulate(load_scenario("line", overrides=HIDDEN | changes), engine="blocks")["avoidance_force"])


def test_what_a_wall_hides_is_not_felt_behind_it():
    """The block behind it is as near as the wall, and shorter."""
    both, sighted = forces(), forces(**{"avoidance.line_of_sight": True})
    alone = forces(**{"avoidance.obstacles": HIDDEN["avoidance.obstacles"][:1]})
    assert float(sighted.max()) == pytest.approx(float(alone.max()), rel=1e-2)
    assert float(both.max()) > 1.2 * float(alone.max())


def test_who_feels_what_is_either_assigned_or_seen():
    changes = {"avoidance": {"sensing": "assigned", "assigned": [1], "line_of_sight": True, "obstacles": [HERE]}}
    with pytest.raises(ScenarioError, match=r"avoidance.line_of_sight: .*assigned"):
        load_scenario("line", overrides=changes)


HERE = {"position": [6.0, 5.05]}
