import numpy as np
import pytest

from drake_formation import ScenarioError, load_scenario, simulate
from drake_formation.measuring.control_law import ControlLaw
from drake_formation.scenario import resolve

OBSTACLES = [{"position": [1.0, 1.1]}, {"position": [1.2, -1.2], "radius": 0.2}]


def scene(**avoidance):
    """Two robots, the first below, and an obstacle beside each."""
    overrides = {
        "robots.start": {"centre": [0.0, 0.0]},
        "transport": {"goal": [5.0, 0.0], "duration": 3.0},
        "aggregation.duration": 0.0,
        "avoidance": {"obstacles": OBSTACLES, "sensing": "assigned", **avoidance},
    }
    return load_scenario("line", overrides=overrides)


@pytest.mark.parametrize("kind", ["khatib", "rotational"])
@pytest.mark.parametrize("engine", ["blocks", "compiled", "exponential"])
def test_an_obstacle_is_felt_by_the_robot_assigned_to_it_alone(kind, engine):
    result = simulate(scene(kind=kind, assigned=[1, 1], range=3.0), engine=engine)
    force = result["avoidance_force"].values
    assert np.abs(force[:, 0]).max() > 1.0
    assert not force[:, 1].any()


def test_where_each_is_assigned_what_it_alone_senses_nothing_changes():
    assigned, in_range = (
        simulate(scene(sensing=sensing, assigned=[2, 1], range=1.2), engine="blocks")
        for sensing in ("assigned", "in_range")
    )
    assert np.abs(in_range["avoidance_force"].values).max(axis=(0, 2)).min() > 0
    np.testing.assert_allclose(assigned["position"].values, in_range["position"].values, rtol=0, atol=1e-12)


def test_the_law_along_a_motion_knows_who_is_assigned():
    scenario = scene(assigned=[2, 1], range=3.0)
    result = simulate(scenario, engine="blocks")
    law = ControlLaw(resolve(scenario))
    force = law(*(result[name].values for name in ("time", "position", "velocity")))
    np.testing.assert_allclose(force, result["control_force"].values, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize(
    ("assigned", "message"),
    [
        ([1], r"avoidance.assigned: 1 robots for 2 obstacles \(got \[1\]\); allowed: 2 numbers of robots from 1 to 2"),
        ([1, 3], r"avoidance.assigned.1: there is no robot 3"),
        ([0, 1], r"avoidance.assigned.0: there is no robot 0"),
    ],
)
def test_assignments_that_cannot_be_are_refused(assigned, message):
    with pytest.raises(ScenarioError, match=message) as caught:
        scene(assigned=assigned)
    assert len(caught.value.faults) == 1
