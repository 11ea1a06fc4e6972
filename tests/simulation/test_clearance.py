import numpy as np
import pytest

from drake_formation import load_scenario, metrics, simulate
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
    centres, radii = np.array([[9.0, 9.0], [0.0, 0.0]]), np.array([0.5, 0.1])
    assert least_clearance(motion, motion.bulge(), centres, radii) == pytest.approx(miss - 0.1, abs=1e-9)


def test_without_obstacles_there_is_no_clearance():
    motion = passing(1.0)
    assert least_clearance(motion, motion.bulge(), np.zeros((0, 2)), np.zeros(0)) is None


LEAP = {"aggregation.duration": 0.0, "robots.start": [[0.0, 3.0], [0.0, 4.0]], "transport.goal": [10.0, 3.5]}


def leaping(engine):
    """Robot 1 passes over an obstacle whose force reaches a millimetre far, in one step."""
    obstacle = {"position": [1.5, 3.0], "radius": 1e-3}
    overrides = LEAP | {"avoidance.obstacles": [{"position": [5.0, 9.0]}, obstacle], "avoidance.range": 1e-3}
    return simulate(load_scenario("line", overrides=overrides | {"transport.duration": 5.0}), engine=engine)


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_no_step_leads_over_an_obstacle(engine):
    """The run is made again in shorter steps, and the robot is pushed aside."""
    result = leaping(engine)
    assert metrics(result).min_clearance_m > 0
    assert contact(series_of(result)) is None


def test_a_robot_that_is_inside_between_two_samples_alone_is_found():
    series = series_of(simulate(load_scenario("line", overrides=LEAP | {"transport.duration": 2.0})))
    assert contact(series) is None
    passed = np.array([[0.5 * (series["position"][0, 0, 0] + series["position"][1, 0, 0]), 3.0]])
    middle = series | {"obstacle_position": passed, "obstacle_radius": np.array([1e-9])}
    middle["clearance"] = np.linalg.norm(series["position"][:, :, None] - passed, axis=-1) - 1e-9
    found = contact(Series(middle, series.scenario, series.choice))
    assert found is not None
    assert found[1:] == (0, 0)


def test_a_run_that_keeps_clear_has_no_contact():
    overrides = {"aggregation.duration": 0.0, "transport.duration": 3.0}
    assert contact(series_of(simulate(load_scenario("line", overrides=overrides)))) is None
