import numpy as np
import pytest

from drake_formation import load_scenario, metrics, simulate
from drake_formation.formation.obstacles import Obstacle, Obstacles
from drake_formation.scenario import with_overrides
from drake_formation.simulation.clearance import contact, least_clearance
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.result import series_of
from drake_formation.simulation.series import Series


def passing(miss):
    """A step of 0.1 s at 10 m/s past a place at a distance (m)."""
    velocity = np.full((2, 1, 2), [10.0, 0.0])
    return Motion(np.array([0.0, 0.1]), np.array([[[-0.3, miss]], [[0.7, miss]]]), velocity, np.zeros((2, 1, 2)))


@pytest.mark.parametrize("miss", [0.05, 0.25])
def test_the_least_clearance_may_lie_between_samples(miss):
    motion = passing(miss)
    obstacles = Obstacles.circles([[9.0, 9.0, 0.5], [0.0, 0.0, 0.1]])
    assert least_clearance(motion, motion.bulge(), obstacles, np.zeros(1)) == pytest.approx(miss - 0.1, abs=1e-9)
    assert least_clearance(motion, motion.bulge(), obstacles, np.array([0.02])) == pytest.approx(miss - 0.12, abs=1e-9)


@pytest.mark.parametrize("moving", [False, True])
def test_the_least_clearance_from_other_shapes_may_lie_between_samples(moving):
    """A wedge whose corner the robot passes; and the same one moved there and away again within the step."""
    wedge = np.array([[0.2, -1.0], [0.2, -0.1], [0.1, -1.0]])
    drift = np.array([[0.0, 0.02, 0.0, 5.0], [0.02, 0.04, 0.0, -5.0]]) if moving else np.zeros((0, 4))
    motion = passing(0.05)
    obstacles = Obstacles((Obstacle(wedge, 0.01, motion=drift), Obstacle(np.array([[5.0, 5.0], [6.0, 5.0]]))))
    times = np.linspace(0.0, 0.1, 100_001)
    dense = obstacles.clearance(motion.at_times(times)[0][:, 0], times).min()
    assert least_clearance(motion, motion.bulge(), obstacles, np.zeros(1)) == pytest.approx(dense, abs=1e-6)


def test_without_obstacles_there_is_no_clearance():
    motion = passing(1.0)
    assert least_clearance(motion, motion.bulge(), Obstacles(), np.zeros(1)) is None


LEAP = {"aggregation.duration": 0.0, "robots.start": [[0.0, 3.0], [0.0, 4.0]], "transport.goal": [10.0, 3.5]}


def leaping(engine):
    """Robot 1 passes over an obstacle whose force reaches a millimetre far, in one step."""
    obstacle = {"position": [1.5, 3.0], "radius": 1e-3}
    overrides = LEAP | {"avoidance.obstacles": [{"position": [5.0, 9.0]}, obstacle], "avoidance.range": 1e-3}
    return simulate(load_scenario("line", overrides=overrides | {"transport.duration": 5.0}), engine=engine)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_no_step_leads_over_an_obstacle(engine):
    """The run is made again in shorter steps, and the robot is pushed aside."""
    result = leaping(engine)
    assert metrics(result).min_clearance_m > 0
    assert contact(series_of(result)) is None


def test_a_robot_that_is_inside_between_two_samples_alone_is_found():
    series = series_of(simulate(load_scenario("line", overrides=LEAP | {"transport.duration": 2.0})))
    assert contact(series) is None
    passed = [0.5 * (series["position"][0, 0, 0] + series["position"][1, 0, 0]), 3.0]
    in_the_way = with_overrides(series.scenario, {"avoidance.obstacles": [{"position": passed, "radius": 1e-9}]})
    middle = series | {"clearance": np.linalg.norm(series["position"][:, :, None] - [passed], axis=-1) - 1e-9}
    found = contact(Series(middle, in_the_way, series.choice))
    assert found is not None
    assert found[1:] == (0, 0)


def test_a_run_that_keeps_clear_has_no_contact():
    overrides = {"aggregation.duration": 0.0, "transport.duration": 3.0}
    assert contact(series_of(simulate(load_scenario("line", overrides=overrides)))) is None
