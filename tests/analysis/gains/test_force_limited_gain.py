"""The largest δ under a force limit: a formula, the limit itself, and the diagram."""

import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_formation import load_scenario, simulate
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.force_limited_gain import largest_gain
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.response.worst_case_force import worst_case_force
from drake_formation.scenario import resolve, with_overrides

ALONE = {"formation": {"shape": "slots", "slots": [[0, 0]]}, "robots.start": {"centre": [2.5, 3.5]}}


@given(limit=st.floats(30, 1e4), error=st.floats(1e-3, 0.1), robots=st.sampled_from([2, 4, 8]))
@settings(max_examples=10, deadline=None)
def test_complete_graphs_have_a_formula(limit, error, robots):
    names = {2: "line", 4: "quadrilateral", 8: "octagon"}
    formation = linearize(load_scenario(names[robots], overrides={"springs.stiffness": 0.0}))
    found = largest_gain(formation, force_limit_n=limit, hand_off_error_m=error, travel_m=22.5)
    expected = ((limit - 22.5) / error - 1) / (2 * (robots - 1))
    assert found.ceiling == pytest.approx(expected, rel=1e-6)
    assert found.delta == pytest.approx(expected, rel=3e-3)
    assert found.delta <= expected


@pytest.mark.parametrize(("graph", "delta_v"), [("complete", 0.0), ("path", 0.0), ("path", 300.0), ("cycle", 0.0)])
def test_the_gain_fits_and_little_more_does_not(graph, delta_v):
    changes = {"consensus.graph": graph, "consensus.delta_v": delta_v}
    formation = linearize(load_scenario("octagon", overrides=changes))
    question = {"hand_off_error_m": 0.02, "travel_m": 25.0}
    found = largest_gain(formation, force_limit_n=500.0, **question)
    assert found.peak.bound_n <= 500
    assert worst_case_force(formation, delta=found.delta, **question).bound_n == pytest.approx(found.peak.bound_n)
    for factor in (1.01, 1.05, 1.2):
        assert worst_case_force(formation, delta=factor * found.delta, **question).force_n > 500
    assert worst_case_force(formation, delta=1.001 * found.ceiling, **question).force_n > 500


@pytest.mark.parametrize("graph", ["complete", "path"])
def test_the_diagram_stays_under_the_limit_and_comes_near(graph):
    """The paper's size of error, 4 cm of four robots, against 1600 N."""
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.graph": graph}))
    found = largest_gain(formation, force_limit_n=1600.0, hand_off_error_m=0.04, travel_m=25.0)
    peak, scenario = found.peak, formation.scenario
    start = resolve(scenario).slots + np.array(scenario.transport.goal) + peak.hand_off_errors + peak.travel
    changes = {
        "robots.start": start.tolist(),
        "consensus.delta": found.delta,
        "transport.duration": 5.0,
        "simulator.max_step_size": 2e-3,
    }
    result = simulate(with_overrides(scenario, changes), engine="compiled")
    reached = np.linalg.norm(result.control_force.values, axis=-1).max()
    assert 0.997 * 1600 <= reached <= 1600


def test_a_larger_limit_and_a_smaller_error_allow_more():
    formation = linearize(load_scenario("octagon", overrides={"consensus.graph": "path"}))
    by_limit = [largest_gain(formation, force_limit_n=f, hand_off_error_m=0.02).delta for f in (10, 100, 1000)]
    by_error = [largest_gain(formation, force_limit_n=100, hand_off_error_m=e).delta for e in (0.1, 0.01, 0.001)]
    assert np.all(np.diff(by_limit) > 0)
    assert np.all(np.diff(by_error) > 0)


def test_it_is_plain_json():
    found = largest_gain(linearize(load_scenario("line")), force_limit_n=50.0, hand_off_error_m=0.01)
    assert json.loads(json.dumps(found.to_dict()))["force_limit_n"] == 50


@pytest.mark.parametrize(
    ("changes", "question", "words"),
    [
        (ALONE, {"force_limit_n": 100.0, "hand_off_error_m": 0.1}, "one robot"),
        ({}, {"force_limit_n": 0.0, "hand_off_error_m": 0.1}, "above 0 N"),
        ({}, {"force_limit_n": 100.0, "hand_off_error_m": 0.0}, "asks no force"),
        ({}, {"force_limit_n": 100.0, "hand_off_error_m": -0.1}, "distances"),
        ({}, {"force_limit_n": 20.0, "hand_off_error_m": 0.1, "travel_m": 22.5}, "too little"),
        ({"consensus.delta_v": 2e4}, {"force_limit_n": 9.0, "hand_off_error_m": 9.0}, "too little"),
    ],
)
def test_questions_without_an_answer_say_so(changes, question, words):
    with pytest.raises(IllPosedError, match=words):
        largest_gain(linearize(load_scenario("line", overrides=changes)), **question)
