"""Obstacles of simulated runs: what they did, against what forces of their impulse could do."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.analysis import linearize
from drake_formation.analysis.response.obstacle_effect import driven_error, obstacle_effect

CASES = {
    "line": {"springs.stiffness": 1.45},
    "line, consensus": {"consensus.delta": 100.0},
    "quadrilateral": {"consensus.delta": 20.0},
}


@pytest.fixture(scope="module", params=CASES)
def run(request):
    scenario = load_scenario(request.param.partition(",")[0], overrides=CASES[request.param])
    return scenario, simulate(scenario)


def test_obstacles_stay_under_the_bound_of_their_impulse(run):
    scenario, result = run
    effect = obstacle_effect(linearize(scenario), result)
    assert 0 < effect.observed_m < effect.bound_m
    assert 0 < effect.driven_m < effect.bound_m


def test_the_linear_loop_driven_by_the_recorded_force_errs_as_the_run_did(run):
    scenario, result = run
    effect = obstacle_effect(linearize(scenario), result)
    assert effect.driven_m == pytest.approx(effect.observed_m, rel=0.05)


def test_impulses_are_those_of_the_recorded_forces(run):
    scenario, result = run
    effect = obstacle_effect(linearize(scenario), result)
    hypot = np.hypot(*np.moveaxis(result["avoidance_force"].values, -1, 0))
    for robot, impulse in enumerate(effect.impulses_ns):
        steps = np.diff(result["time"].values)
        assert impulse == pytest.approx(float((steps * (hypot[1:, robot] + hypot[:-1, robot]) / 2).sum()))
    assert effect.to_dict()["impulses_ns"] == effect.impulses_ns


def test_a_constant_force_is_borne_by_the_springs():
    """At rest a force on one of two robots is shared: e = F/2 / (1 + 2δ)."""
    formation = linearize(load_scenario("line", overrides={"consensus.delta": 3.0, "springs.stiffness": 0.0}))
    force = np.zeros((2, 2, 2))
    force[:, 0, 0] = 4.0
    _, error = driven_error(formation, np.array([0.0, 200.0]), force)
    np.testing.assert_allclose(error[-1], [[2.0 / 7, 0], [-2.0 / 7, 0]], atol=1e-6)


def test_a_result_of_another_formation_is_refused():
    scenario = load_scenario("line", overrides={"aggregation.duration": 0, "transport.duration": 0.1})
    with pytest.raises(ValueError, match="as many robots"):
        obstacle_effect(linearize(load_scenario("quadrilateral")), simulate(scenario))
