"""The worst hand-off: what a formula says, and what the diagram does when it is given it."""

import json

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.response.worst_case_force import worst_case_force
from drake_formation.scenario import resolve, with_overrides


def carried_out(formation, peak):
    """The diagram's forces (N) from the worst hand-off errors on, shape (time, robot), and their times."""
    scenario = formation.scenario
    start = resolve(scenario).slots + np.array(scenario.transport.goal) + peak.hand_off_errors + peak.travel
    changes = {
        "robots.start": start.tolist(),
        "transport.duration": 4.0,
        "simulator.accuracy": 1e-9,
        "simulator.max_step_size": 2e-3,
    }
    result = simulate(with_overrides(scenario, changes), engine="compiled")
    return np.linalg.norm(result.control_force.values, axis=-1), result.time.values


@pytest.mark.parametrize(("name", "robots"), [("line", 2), ("quadrilateral", 4), ("octagon", 8)])
@pytest.mark.parametrize("delta", [0.0, 1e4, 2e4])
def test_in_complete_graphs_one_robot_stands_against_all_others(name, robots, delta):
    formation = linearize(load_scenario(name, overrides={"consensus.delta": delta, "springs.stiffness": 0.0}))
    peak = worst_case_force(formation, hand_off_error_m=0.04, travel_m=22.5)
    assert peak.force_n == pytest.approx((2 * (robots - 1) * delta + 1) * 0.04 + 22.5)
    assert peak.time_s == 0
    against = peak.hand_off_errors @ peak.travel / (0.04 * 22.5)
    np.testing.assert_allclose(np.sort(against * np.sign(delta or 1)), np.sort(against))
    assert np.linalg.norm(peak.hand_off_errors, axis=1) == pytest.approx(0.04 if delta else peak_lengths(peak))


def peak_lengths(peak):
    """Without consensus only the robot concerned matters."""
    return [0.04 if robot + 1 == peak.robot else 0.0 for robot in range(len(peak.hand_off_errors))]


def test_published_errors_and_forces_of_four_robots_contradict_each_other():
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.delta": 1e4}))
    outward = 1e4 * 4 * 0.04  # one robot 4 cm from the mean of all
    assert outward == pytest.approx(1600)
    assert worst_case_force(formation, hand_off_error_m=0.04).force_n == pytest.approx(2 * 3 / 4 * outward, rel=1e-3)


@pytest.mark.parametrize("stiffness", [1.45, 3e4])
@pytest.mark.parametrize("graph", ["complete", "path", "star"])
def test_the_diagram_reaches_the_force_and_stays_under_the_bound(graph, stiffness):
    changes = {"consensus.graph": graph, "consensus.delta": 1e4, "springs.stiffness": stiffness}
    formation = linearize(load_scenario("quadrilateral", overrides=changes))
    # 1 mm: steel springs are linear only for small errors.
    peak = worst_case_force(formation, hand_off_error_m=1e-3, travel_m=25.0)
    forces, times = carried_out(formation, peak)
    assert forces.max() <= peak.bound_n * (1 + 2e-3)
    assert forces.max() == pytest.approx(peak.force_n, rel=3e-3)
    when, robot = np.unravel_index(forces.argmax(), forces.shape)
    assert times[when] == pytest.approx(peak.time_s, abs=5e-3)
    assert forces[when, peak.robot - 1] == pytest.approx(forces[when, robot], rel=1e-6)


def test_errors_run_through_a_path_and_meet_later():
    formation = linearize(load_scenario("octagon", overrides={"consensus.graph": "path", "consensus.delta": 1e4}))
    peak = worst_case_force(formation, hand_off_error_m=0.01)
    assert peak.time_s > 0.1
    assert peak.force_n > 4 * 1e4 * 0.01  # two neighbours, each on the other side


def test_other_gains_than_the_scenarios():
    formation = linearize(load_scenario("line"))
    stiff = linearize(load_scenario("line", overrides={"consensus.delta": 50.0, "consensus.delta_v": 9.0}))
    asked = worst_case_force(formation, hand_off_error_m=0.1, delta=50.0, delta_v=9.0)
    assert asked.force_n == pytest.approx(worst_case_force(stiff, hand_off_error_m=0.1).force_n)


def test_it_is_plain_json():
    peak = worst_case_force(linearize(load_scenario("line")), hand_off_error_m=0.1, travel_m=1.0)
    assert json.loads(json.dumps(peak.to_dict()))["robot"] in (1, 2)


@pytest.mark.parametrize("distances", [(-1.0, 0.0), (0.1, float("inf")), (float("nan"), 0.0)])
def test_what_is_no_distance_is_refused(distances):
    formation = linearize(load_scenario("line"))
    with pytest.raises(IllPosedError, match="distances"):
        worst_case_force(formation, hand_off_error_m=distances[0], travel_m=distances[1])
