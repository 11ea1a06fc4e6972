import numpy as np
import pytest

from drake_formation import SimulationError, load_scenario, simulate
from drake_formation.simulation.clearance import contact, least_clearance
from drake_formation.simulation.motion import Motion


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
    return simulate(load_scenario("line", overrides=overrides | {"transport.duration": 10.0}), engine=engine)


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_a_step_over_an_obstacle_is_refused(engine):
    with pytest.raises(SimulationError, match="robot 1 is inside obstacle 2") as caught:
        leaping(engine)
    partial = caught.value.partial
    assert (partial["clearance"] > 0).all(), "a sample is inside: the test says nothing"
    near = partial["position"].sel(robot=1).sel(time=caught.value.time, method="nearest")
    assert abs(float(near[0]) - 1.5) < 0.2


def test_a_run_that_keeps_clear_has_no_contact():
    from drake_formation.simulation.result import series_of

    overrides = {"aggregation.duration": 0.0, "transport.duration": 3.0}
    assert contact(series_of(simulate(load_scenario("line", overrides=overrides)))) is None
