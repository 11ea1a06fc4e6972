"""Obstacles smaller than a step are neither stepped into nor over, on any engine."""

import json

import numpy as np
import pytest

from drake_formation import SimulationError, load_scenario, simulate

ENGINES = ("compiled", "exponential", "blocks")


def passing(at, reach, radius, beside, **changes):
    """One robot on its way along the x axis past an obstacle, from rest to 22.5 m."""
    overrides = {
        "formation": {"shape": "line", "robots": 1, "side": 1.0},
        "robots.start": {"centre": [0.0, 0.0]},
        "transport.goal": [22.5, 0.0],
        "transport.duration": 8.0,
        "aggregation.duration": 0.0,
        "avoidance.range": reach,
        "avoidance.obstacles": [{"position": [at, beside], "radius": radius}],
    }
    return load_scenario("line", overrides={**overrides, **changes})


def final(scenario, engine="compiled"):
    return simulate(scenario, engine=engine)["position"].values[-1, 0]


def tight(*case):
    return final(passing(*case, **{"simulator.accuracy": 1e-11, "simulator.max_step_size": 1e-3}))


@pytest.mark.parametrize("at", np.linspace(5.0, 6.0, 21).tolist())
def test_an_obstacle_of_half_a_step_is_passed_wherever_it_lies(at):
    case = (at, 0.05, 0.05, 0.01)
    expected = tight(*case)
    for engine in ENGINES:
        np.testing.assert_allclose(final(passing(*case), engine), expected, rtol=0, atol=1e-3, err_msg=engine)


SIZES = [(0.05, 0.0, 0.01), (0.02, 0.02, 0.003), (0.1, 0.0, 0.03), (0.2, 0.3, 0.05), (0.3, 0.01, 0.2)]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(("reach", "radius", "beside"), SIZES)
def test_other_sizes_too(reach, radius, beside, engine):
    case = (5.37, reach, radius, beside)
    np.testing.assert_allclose(final(passing(*case), engine), tight(*case), rtol=0, atol=1e-3)


@pytest.mark.parametrize("engine", ["compiled", "exponential"])
@pytest.mark.parametrize("at", [5.0, 5.25, 5.75])
def test_an_obstacle_is_not_leapt_over(at, engine):
    """Its range is a tenth of a step: without shorter steps the compiled run ends 5 m off, as if it were not there."""
    case = (at, 0.01, 0.0, 0.002)
    np.testing.assert_allclose(final(passing(*case), engine), tight(*case), rtol=0, atol=1e-3)


@pytest.mark.parametrize("scheme", ["runge_kutta3", "bogacki_shampine3", "radau3"])
def test_drakes_other_integrators_do_not_step_into_it_either(scheme):
    case = (5.2, 0.05, 0.05, 0.01)
    found = final(passing(*case, **{"simulator.integration_scheme": scheme}), "blocks")
    np.testing.assert_allclose(found, tight(*case), rtol=0, atol=1e-3)


@pytest.mark.parametrize("engine", ENGINES)
def test_fixed_steps_that_would_overlook_it_are_refused(engine):
    scenario = passing(5.2, 0.01, 0.0, 0.002, **{"simulator.use_error_control": False})
    with pytest.raises(SimulationError, match=r"robot 1 passes obstacle 1 .* Try simulator.max_step_size=0.0"):
        simulate(scenario, engine=engine)


@pytest.mark.parametrize("engine", ENGINES)
def test_fixed_steps_that_end_inside_are_refused(engine):
    scenario = passing(5.2, 0.4, 0.4, 0.0, **{"simulator.use_error_control": False, "avoidance.gain": 1e-3})
    with pytest.raises(SimulationError, match="obstacle 1"):
        simulate(scenario, engine=engine)


def test_an_obstacle_too_small_for_any_sensible_step_is_refused():
    with pytest.raises(SimulationError, match=r"may overlook it.*larger avoidance.range"):
        simulate(passing(5.2, 1e-5, 0.0, 0.0), engine="compiled")


@pytest.mark.parametrize("engine", ENGINES)
def test_an_obstacle_is_no_obstacle_before_the_hand_off(engine):
    """While they gather, robot 2 drives through it."""
    changes = {"robots.start": [[4.0, 5.0], [1.0, 2.0]], "aggregation.duration": 20.0, "transport.duration": 2.0}
    through = {"avoidance.obstacles": [{"position": [1.3, 2.4], "radius": 0.2}], "avoidance.range": 0.2}
    runs = [
        simulate(load_scenario("line", overrides={**changes, **avoidance}), engine=engine)
        for avoidance in (through, {"avoidance.obstacles": []})
    ]
    assert runs[0]["clearance"].min() < -0.1
    gathered = [run["position"].sel(time=slice(0, 20)).values[-1] for run in runs]
    np.testing.assert_allclose(*gathered, rtol=0, atol=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_an_obstacle_without_a_gain_is_none(engine):
    scenario = passing(5.2, 0.05, 0.05, 0.0, **{"avoidance.gain": 0.0})
    free = passing(5.2, 0.05, 0.05, 0.0, **{"avoidance.obstacles": []})
    np.testing.assert_allclose(final(scenario, engine), final(free, engine), rtol=0, atol=1e-12)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_robot_inside_an_obstacle_at_the_hand_off_is_named(engine):
    overrides = {
        "aggregation.duration": 4.0,
        "transport.duration": 2.0,
        "avoidance.obstacles": [{"position": [1.25, 2.3], "radius": 0.1}],
    }
    with pytest.raises(SimulationError, match=r"robot 2 is inside obstacle 1 at t = 4 s") as caught:
        simulate(load_scenario("line", overrides=overrides), engine=engine)
    assert caught.value.partial["time"].values[-1] == 4.0


TIE = {
    "aggregation.duration": 0.0,
    "robots.start": {"centre": [8.0, 3.5]},
    "transport.goal": [25.0, 3.5],
    "transport.duration": 6.0,
    "consensus.delta": 1e4,
    "consensus.delta_v": 300.0,
    "avoidance.sensing": "nearest",
    "avoidance.obstacles": [{"position": [10.0, 3.5]}],
}


def remark(**changes):
    return simulate(load_scenario("quadrilateral", overrides={**TIE, **changes}), engine="compiled").attrs.get("remark")


def test_robots_that_see_an_obstacle_in_turns_are_remarked_upon():
    assert remark().startswith("Obstacle 1 was seen by another robot ")
    assert remark(**{"avoidance.sensing": "in_range"}) is None
    assert remark(**{"avoidance.gain": 0.0}) is None
    assert remark(**{"avoidance.obstacles": [{"position": [10.0, 5.0]}]}) is None


def test_the_command_passes_the_remark_on(cli):
    settings = [part for path, value in TIE.items() for part in ("--set", f"{path}={json.dumps(value)}")]
    status, out, _ = cli("run", "quadrilateral", *settings, "--engine", "compiled", "--out", "tie")
    assert status == 0
    assert "Try avoidance.sensing=in_range" in out
