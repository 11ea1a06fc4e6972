"""Measures: each is the number that the disturbance analysis or a simulated run gives."""

import numpy as np
import pytest

from drake_formation import load_scenario, metrics, simulate
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.response.disturbance import disturbance
from drake_formation.analysis.response.error_criteria import ForceNoise, HandOff, Pulse, Vibration
from drake_formation.scenario import with_overrides

FREE = {"avoidance.obstacles": [], "consensus.delta": 200.0, "transport.duration": 20.0, "simulator.accuracy": 1e-8}


def test_measures_are_the_disturbance_analysis_scaled():
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.delta": 50.0}))
    found = disturbance(formation)
    assert Pulse(3.0).error_m(formation) == pytest.approx(3 * found.pulse.bound.max())
    assert ForceNoise(3.0).error_m(formation) == pytest.approx(3 * found.force_floor.max())
    assert Vibration(3.0).error_m(formation) == pytest.approx(3 * found.hinf_all.gain, rel=3e-6)


@pytest.mark.parametrize("graph", ["complete", "cycle", "star"])
def test_error_from_the_hand_off_on_is_that_of_a_run(graph):
    scenario = load_scenario("quadrilateral", overrides=FREE | {"consensus.graph": graph})
    error = HandOff(scenario).error_m(linearize(scenario))
    assert error == pytest.approx(metrics(simulate(scenario)).consensus_error_m, rel=5e-3)


def test_unequal_robots_disagree_on_the_way():
    """Heavier robots lag behind: the step to the goal is part of the hand-off."""
    overrides = FREE | {"robots.mass": [20.0, 80.0], "transport.goal": [4.0, 3.5], "springs.law": "linear"}
    scenario = load_scenario("line", overrides=overrides)
    error = HandOff(scenario).error_m(linearize(scenario))
    assert error == pytest.approx(metrics(simulate(scenario)).consensus_error_m, rel=5e-3)
    near = with_overrides(scenario, {"transport.goal": [2.5, 3.5]})
    assert error > 1.5 * HandOff(near).error_m(linearize(near))


def test_a_formation_that_starts_in_place_has_nothing_left():
    scenario = load_scenario("line", overrides=FREE | {"robots.start": {"centre": [0, 0]}})
    assert HandOff(scenario).error_m(linearize(scenario)) == pytest.approx(0, abs=1e-12)


def test_a_moving_reference_is_refused():
    scenario = load_scenario("line", overrides={"transport.reference": {"kind": "minimum_jerk"}})
    with pytest.raises(IllPosedError, match="set point"):
        HandOff(scenario).error_m(linearize(scenario))
    with pytest.raises(IllPosedError, match="the formation 4"):
        HandOff(load_scenario("line")).error_m(linearize(load_scenario("quadrilateral")))


@pytest.mark.parametrize("measure", [Pulse(2.0), ForceNoise(2.0), Vibration(2.0), HandOff(load_scenario("line"))])
def test_every_measure_says_what_it_is(measure):
    assert "error" in str(measure)
    assert "2 N" in str(measure) or "line" in str(measure)
    assert np.isfinite(measure.error_m(linearize(load_scenario("line"))))
