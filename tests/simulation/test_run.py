from itertools import pairwise

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from strategies import scenarios

from drake_formation import Scenario, ScenarioError, SimulationError, load_scenario, metrics, simulate, with_overrides
from drake_formation.simulation import simulated_duration

SHORT = {"aggregation.duration": 1.0, "transport.duration": 2.0}


def line(**overrides):
    return load_scenario("line", overrides=SHORT | {key.replace("__", "."): value for key, value in overrides.items()})


# Any scenario


@settings(max_examples=8)
@given(scenarios())
def test_any_sound_scenario_runs_from_beginning_to_end(scenario):
    scenario = with_overrides(scenario, {"simulator.accuracy": 1e-4, "transport.duration": 0.5})
    result = simulate(scenario, engine="blocks")
    assert result["time"].values[[0, -1]].tolist() == [0, 0.5]
    assert (np.diff(result["time"]) > 0).all()
    assert np.isfinite(result["position"]).all()


def test_two_runs_are_identical():
    xr.testing.assert_identical(simulate(line()), simulate(line()))


@pytest.mark.parametrize("law", ["hookean", "linear"])
def test_a_mirrored_scenario_runs_mirrored(law):
    """A square over an obstacle on its axis, out of formation alike above and below."""
    scenario = over_an_obstacle(
        slots=[[-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5], [0.5, 0.5]],
        start=[[-2.6, 0.7], [-2.6, -0.7], [-1.5, -0.5], [-1.5, 0.5]],
        law=law,
    )
    result = simulate(scenario)
    position = result["position"].values
    assert result["avoidance_force"].values.any()
    np.testing.assert_allclose(position[:, [1, 0, 3, 2]] * [1, -1], position, rtol=0, atol=1e-9)


def test_robots_equally_near_to_an_obstacle_share_it():
    """Two robots: with more, the order of sums breaks the tie in the last digit and they take turns from then on."""
    scenario = over_an_obstacle(slots=[[0.0, 0.5], [0.0, -0.5]], start=[[-2.0, 0.7], [-2.0, -0.7]], sensing="nearest")
    result = simulate(scenario)
    position, force = result["position"].values, result["avoidance_force"].values
    assert force.any()
    np.testing.assert_array_equal(position[:, ::-1] * [1, -1], position)
    np.testing.assert_array_equal(force[:, ::-1] * [1, -1], force)


def over_an_obstacle(slots, start, law="hookean", sensing="in_range"):
    return Scenario.model_validate(
        {
            "name": "mirror",
            "formation": {"shape": "slots", "slots": slots},
            "robots": {"start": start},
            "springs": {"law": law, "stiffness": 100.0},
            "consensus": {"delta": 50.0},
            "avoidance": {"obstacles": [{"position": [0.0, 0.0]}], "sensing": sensing},
            "aggregation": {"duration": 1.0},
            "transport": {"goal": [4.0, 0.0], "duration": 6.0},
        }
    )


# Small scenarios


def test_a_single_robot_runs():
    result = simulate(line(formation__robots=1, robots__start=[[4.0, 5.0]]))
    assert result.sizes["spring"] == 0
    np.testing.assert_array_equal(result["consensus_error"], 0)
    assert metrics(result).max_spring_strain is None


def test_robots_without_springs_and_obstacles_move_on_their_own():
    result = simulate(line(springs__graph=[], avoidance__obstacles=[]))
    assert result.sizes["spring"] == result.sizes["obstacle"] == 0
    # The two start 1.5 m to either side of the mean: their mean moves as one robot that starts there.
    alone = simulate(line(formation__robots=1, robots__start=[[2.5, 3.5]], avoidance__obstacles=[]))
    mean, expected = (run["position"].isel(time=-1).mean("robot") for run in (result, alone))
    np.testing.assert_allclose(mean, expected, atol=1e-6)


def test_a_run_may_begin_with_the_transport():
    result = simulate(line(aggregation__duration=0.0))
    assert (result["phase"] == 1).all()
    assert result["time"].values[[0, -1]].tolist() == [0, 2]


def test_fixed_steps_are_as_long_as_asked():
    result = simulate(
        line(simulator__integration_scheme="explicit_euler", simulator__use_error_control=False,
             simulator__max_step_size=0.0625)
    )  # fmt: skip
    np.testing.assert_allclose(np.diff(result["time"]), 0.0625, rtol=1e-9)


def test_an_unsound_scenario_is_refused():
    scenario = line()
    unsound = scenario.model_copy(update={"robots": scenario.robots.model_copy(update={"mass": (1.0,)})})
    with pytest.raises(ScenarioError):
        simulate(unsound)


# Progress


@pytest.mark.parametrize("obstacles", [[], [{"position": [6.0, 5.05]}]])
def test_progress_goes_up_to_the_simulated_duration(obstacles):
    heard = []
    scenario = line(avoidance__obstacles=obstacles, simulator__start_time=7.0)
    simulate(scenario, progress=heard.append)
    assert simulated_duration(scenario) == (5.0 if obstacles else 3.0)
    assert heard[0] == 0
    assert heard[-1] == pytest.approx(simulated_duration(scenario), abs=1e-9)
    assert all(b >= a - 1e-9 for a, b in pairwise(heard))


# Failures

EULER = {
    "simulator.integration_scheme": "explicit_euler",
    "simulator.use_error_control": False,
    "simulator.max_step_size": 0.1,
}


def failure(scenario):
    with pytest.raises(SimulationError) as caught:
        simulate(scenario)
    return caught.value


@pytest.fixture(scope="module")
def divergence():
    """Steel and strong consensus on steps far too long for them."""
    return failure(load_scenario("line", overrides=EULER | {"springs.stiffness": 3e4, "consensus.delta": 2e4}))


def test_a_diverging_run_says_when_which_robot_and_what_to_try(divergence):
    assert divergence.robot in {1, 2}
    assert 0 < divergence.time < 120
    assert f"t = {divergence.time:.6g} s" in str(divergence)
    assert f"robot {divergence.robot}" in str(divergence)
    assert "simulator.max_step_size" in str(divergence)


def test_a_diverging_run_leaves_what_was_recorded(divergence):
    partial = divergence.partial
    assert partial.sizes["time"] > 10
    assert partial["time"].values[-1] == divergence.time
    assert np.isfinite(partial["position"]).all()
    assert partial["position"].attrs["units"] == "m"


def test_a_divergence_that_robots_share_unequally_names_the_faster():
    overrides = EULER | {"robots.mass": [40.0, 1e-3], "aggregation.duration": 0.0}
    assert failure(load_scenario("line", overrides=overrides)).robot == 2


def test_a_run_whose_error_cannot_be_controlled_says_so():
    error = failure(line(avoidance__gain=1e200, aggregation__duration=0.0, transport__duration=10.0))
    assert "the integrator gave up" in str(error)
    assert "simulator.accuracy" in str(error)
    assert error.time > 0


def test_a_run_that_fails_at_once_leaves_its_first_sample():
    error = failure(line(springs__stiffness=1e300, aggregation__duration=0.0, robots__start=[[1.0, 2.0], [1.0, 2.5]]))
    assert error.time == 0
    assert error.partial["time"].values.tolist() == [0]


def meeting(**overrides):
    """Two robots without forces between them, one of which Euler's second step puts exactly upon the other.

    m = 2 kg, K = [I, √5 I] and steps of 1 s: a robot 2 m short of its slot is 1 m nearer after two steps.
    """
    return Scenario.model_validate(
        {
            "name": "meeting",
            "formation": {"shape": "slots", "slots": [[-0.5, 0.0], [0.5, 0.0]]},
            # Far out, where the gain's last digits round away.
            "robots": {"start": [[4095.5, 0.0], [4094.5, 0.0]], "mass": 2.0},
            "springs": {"stiffness": 0.0},
            "transport": {"goal": [4096.0, 0.0]},
            "simulator": {"integration_scheme": "explicit_euler", "use_error_control": False, "max_step_size": 1.0},
            **overrides,
        }
    )


def test_robots_that_meet_stop_the_run():
    error = failure(meeting())
    assert (error.time, error.robot) == (2.0, 2)
    last = error.partial["position"].isel(time=-1)
    np.testing.assert_array_equal(last[0], last[1])
    assert "met another robot" in str(error)


def test_a_robot_that_begins_in_the_middle_of_an_obstacle_stops_the_run():
    obstacle = {"obstacles": [{"position": [4095.5, 0.5]}]}
    start = {"start": [[4090.0, 0.0], [4094.5, 0.5]], "mass": 2.0}
    slots = {"shape": "slots", "slots": [[-6.0, 0.0], [0.5, 0.5]]}
    error = failure(meeting(avoidance=obstacle | {"range": 0.25}, robots=start, formation=slots))
    assert "inside obstacle 1" in str(error)


def test_a_robot_that_jumps_into_an_obstacle_stops_the_run():
    obstacle = {"obstacles": [{"position": [4095.5, 0.5], "radius": 0.2}]}
    start = {"start": [[4090.0, 0.0], [4094.5, 0.6]], "mass": 2.0}
    slots = {"shape": "slots", "slots": [[-6.0, 0.0], [0.5, 0.6]]}
    error = failure(meeting(avoidance=obstacle | {"range": 0.25}, robots=start, formation=slots))
    assert error.robot == 2
    assert "inside obstacle 1" in str(error)


def test_a_failure_of_the_obstacle_free_response_keeps_the_whole_run():
    """The obstacle pushes robot 2 aside; without it, it meets robot 1."""
    obstacle = {"obstacles": [{"position": [4094.5, -5.5], "radius": 5.0}], "range": 1.0, "gain": 0.1}
    error = failure(meeting(avoidance=obstacle))
    assert error.partial["time"].values[-1] == 60.0
    assert "met another robot" in str(error)


def test_an_error_of_the_caller_is_not_taken_for_a_failed_run():
    def broken(_):
        raise LookupError

    with pytest.raises(LookupError):
        simulate(line(), progress=broken)


def test_a_run_may_be_interrupted():
    def interrupt(_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        simulate(line(), progress=interrupt)
