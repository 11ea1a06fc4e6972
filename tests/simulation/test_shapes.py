"""Whole runs past obstacles of every shape that move, by robots with footprints."""

import numpy as np
import pytest

from drake_formation import ScenarioError, SimulationError, load_scenario, metrics, simulate
from drake_formation.formation.obstacles import Obstacle, Obstacles
from drake_formation.parts.avoidance.khatib import avoidance_force
from drake_formation.simulation.events import events
from drake_formation.simulation.run import PreparedRun

QUICK = {
    "aggregation.duration": 0.0,
    "robots.start": {"centre": [0.0, 3.0]},
    "transport": {"goal": [12.0, 3.0], "duration": 8.0},
    "simulator.accuracy": 1e-8,
}
BOX = {"kind": "polygon", "vertices": [[4.0, 4.4], [5.5, 4.2], [5.2, 5.0], [4.0, 5.0]]}
WALL = {"kind": "segment", "ends": [[3.0, 1.5], [4.0, 1.6]], "radius": 0.1}
BALL = {"position": [6.0, 4.6], "radius": 0.2, "velocity": [-0.3, -0.2], "start": 1.0}


def scenario(*obstacles, **changes):
    return load_scenario("line", overrides={**QUICK, "avoidance.obstacles": list(obstacles), **changes})


def positions(example, engine="blocks"):
    return simulate(example, engine=engine)["position"]


EVERYTHING = {
    "robots.radius": [0.1, 0.2],
    "avoidance.robots": True,
    "avoidance.spacing": 0.3,
    "avoidance.line_of_sight": True,
}


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree_with_everything_at_once(engine):
    example = scenario(BOX, WALL, BALL, **EVERYTHING)
    found, blocks = (positions(example, name).values[-1] for name in (engine, "blocks"))
    np.testing.assert_allclose(found, blocks, rtol=0, atol=1e-5)


def test_one_that_moves_is_felt_where_it_is():
    moving = BOX | {"waypoints": [{"time": 4.0, "position": [6.0, 4.2]}, {"time": 7.0, "position": [6.0, 4.6]}]}
    result = simulate(scenario(moving, BALL, **{"robots.start": {"centre": [4.0, 3.0]}}), engine="blocks")
    box, ball = np.moveaxis(result["obstacle_outline"].values, 1, 0)
    expected = np.zeros(result["position"].shape)
    for k, places in enumerate(result["position"].values):
        there = Obstacles((Obstacle(box[k]), Obstacle(ball[k, :1], 0.2)))
        for robot, place in enumerate(places):
            vectors, surfaces = there.away(place)
            for (dx, dy), surface in zip(vectors, surfaces, strict=True):
                expected[k, robot] += avoidance_force(float(dx), float(dy), float(surface), 1.3, 31.56)
    assert np.abs(expected).max() > 10
    np.testing.assert_allclose(result["avoidance_force"], expected, rtol=1e-9, atol=1e-9)


def test_one_that_could_move_and_does_not_is_felt_as_one_at_rest():
    still = [obstacle | {"velocity": [0.0, 0.0]} for obstacle in (BOX, WALL)]
    found, expected = positions(scenario(*still)).values[-1], positions(scenario(BOX, WALL)).values[-1]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


def test_a_changed_velocity_needs_no_rebuild():
    prepared = PreparedRun(scenario(BALL), engine="blocks")
    faster = scenario(BALL | {"velocity": [-0.6, -0.3], "start": 0.5})
    np.testing.assert_array_equal(prepared.run(faster)["position"], positions(faster).values)
    assert not np.array_equal(positions(faster).values[-1], positions(scenario(BALL)).values[-1])


def test_a_footprint_is_as_good_as_a_larger_obstacle():
    """Until it touches, nothing distinguishes them."""
    point = simulate(scenario(BOX | {"radius": 0.25}), engine="blocks")
    wide = simulate(scenario(BOX | {"radius": 0.05}, **{"robots.radius": 0.2}), engine="blocks")
    np.testing.assert_allclose(point["position"].values[-1], wide["position"].values[-1], rtol=0, atol=1e-6)
    assert metrics(point).min_clearance_m == pytest.approx(metrics(wide).min_clearance_m, abs=1e-6)


@pytest.mark.slow
def test_the_exponential_engine_refuses_a_notch_by_name():
    notched = {"kind": "polygon", "vertices": [[4.0, 4.2], [6.0, 4.2], [6.0, 6.0], [5.0, 4.5], [4.0, 6.0]]}
    with pytest.raises(ScenarioError, match=r"avoidance.obstacles.1: the engine exponential .* notch"):
        simulate(scenario(BOX, notched), engine="exponential")


THIN = {
    "segment": {"kind": "segment", "ends": [[3.0, 2.0], [3.0, 5.0]]},
    "polygon": {"kind": "polygon", "vertices": [[3.0, 2.0], [3.1, 2.0], [3.1, 5.0], [3.0, 5.0]]},
    "moving": {"position": [3.0, 3.5], "radius": 0.1, "velocity": [-0.4, 0.0]},
}


@pytest.mark.parametrize("shape", THIN.values(), ids=THIN)
def test_no_robot_leaps_over_what_is_thinner_than_a_step(shape):
    result = simulate(scenario(shape, **{"avoidance.range": 0.05, "transport.duration": 6.0}), engine="blocks")
    assert metrics(result).min_clearance_m > 0
    assert float(result["position"].sel(axis="x").max()) < 3.0 or shape is THIN["moving"]


UNFELT = {"avoidance.sensing": "assigned", "avoidance.assigned": [1], "transport.goal": [1.0, 3.0]}


def box_moving_over(bottom):
    corners = [[4.0, bottom], [5.0, bottom], [5.0, bottom + 0.8], [4.0, bottom + 0.8]]
    return {"kind": "polygon", "vertices": corners, "velocity": [-2.0, 0.0]}


def test_a_point_inside_a_shape_ends_the_run():
    with pytest.raises(SimulationError, match=r"robot 2 is inside obstacle 1"):
        simulate(scenario(box_moving_over(3.2), **UNFELT), engine="blocks")


def test_a_footprint_that_touches_does_not():
    result = simulate(scenario(box_moving_over(3.7), **UNFELT, **{"robots.radius": 0.3}), engine="blocks")
    assert float(result["clearance"].sel(robot=2).min()) < 0
    assert metrics(result).min_clearance_m < 0
    (touching,) = [event for event in events(result) if event.kind == "collision"]
    assert touching.sentence == "robot 2 touches obstacle 1"
    assert touching.who == (2,)
