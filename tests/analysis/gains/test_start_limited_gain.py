"""Peak forces of a scenario's own run, against the run."""

import json

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.analysis.gains.start_limited_gain import start_force, start_limited_gain
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.scenario import with_overrides

CLEAR = {"avoidance.obstacles": []}
FINE = {"transport.duration": 10.0, "simulator.max_step_size": 2e-3}


def forces_of(scenario):
    """Peak force (N) of aggregation and transport, and the hand-off error (m), of a run without obstacles."""
    result = simulate(with_overrides(scenario, {**CLEAR, **FINE}), engine="compiled")
    force = np.linalg.norm(result.control_force.values, axis=-1).max(axis=1)
    carried = result.phase.values == 1
    errors = (result.position - result.aggregation_centre - result.slot).values[carried][0]
    return force[~carried].max(initial=0.0), force[carried].max(), np.linalg.norm(errors, axis=1).max()


@pytest.mark.slow
@pytest.mark.parametrize(("name", "delta"), [("line", 0.0), ("line", 1e4), ("quadrilateral", 2e4), ("octagon", 50.0)])
def test_the_run_has_these_forces(name, delta):
    scenario = load_scenario(name, overrides={"consensus.delta": delta})
    found = start_force(scenario)
    aggregation, transport, error = forces_of(scenario)
    assert transport <= found.transport_n * (1 + 1e-4)
    assert transport == pytest.approx(found.transport_n, rel=2e-3)
    assert aggregation == pytest.approx(found.aggregation_n, rel=2e-3)
    assert error == pytest.approx(found.hand_off_error_m, rel=2e-3, abs=1e-6)


def test_forces_of_the_line_are_those_of_the_reproduction():
    """Published 22.5, 45 and 95 N; the README's table says why 73 and 132 N."""
    forces = [start_force(load_scenario("line"), delta=delta).transport_n for delta in (0.0, 1e4, 2e4)]
    assert forces == pytest.approx([22.5, 73.1, 131.8], abs=0.1)


def test_without_aggregation_the_start_is_the_hand_off():
    start = {"aggregation.duration": 0.0, "robots.start": [[2.5, 3.0], [2.6, 4.0]], "consensus.delta": 100.0}
    scenario = load_scenario("line", overrides=start)
    found = start_force(scenario)
    assert found.aggregation_n == 0
    assert (found.hand_off_error_m, found.consensus_error_m) == pytest.approx((0.05, 0.05))
    assert forces_of(scenario)[1] == pytest.approx(found.transport_n, rel=2e-3)


@pytest.mark.parametrize("aggregation", [False, True])
def test_the_run_with_the_largest_gain_stays_under_the_limit_and_comes_near(aggregation):
    scenario = load_scenario("quadrilateral")
    found = start_limited_gain(scenario, force_limit_n=100.0, aggregation=aggregation)
    gathering, transport, _ = forces_of(with_overrides(scenario, {"consensus.delta": found.delta}))
    assert 99 <= (max(gathering, transport) if aggregation else transport) <= 100.02


def test_it_is_plain_json():
    assert json.loads(json.dumps(start_force(load_scenario("line")).to_dict()))["delta_n_per_m"] == 0


@pytest.mark.parametrize(
    ("changes", "limit", "words"),
    [
        ({}, 20.0, "too little"),
        ({}, -1.0, "above 0 N"),
        ({"transport.reference": {"kind": "minimum_jerk"}}, 100.0, "minimum_jerk"),
        ({"robots.start": {"centre": [2.5, 3.5]}}, 100.0, "has no consensus error"),
        ({"formation": {"shape": "slots", "slots": [[0, 0]]}, "robots.start": {"centre": [2.5, 3.5]}}, 100.0, "one"),
    ],
)
def test_questions_without_an_answer_say_so(changes, limit, words):
    with pytest.raises(IllPosedError, match=words):
        start_limited_gain(load_scenario("line", overrides=changes), force_limit_n=limit)
