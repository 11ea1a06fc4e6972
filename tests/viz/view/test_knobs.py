"""Sliders change what they are named after, and nothing as long as they rest."""

import pytest

from drake_formation import load_scenario
from drake_formation.viz.view.knobs import KNOBS, changed

DELTA, DELTA_V, STIFFNESS = KNOBS


def test_sliders_that_rest_leave_the_scenario_alone():
    scenario = load_scenario("line")
    places = {knob: knob.shown(scenario) for knob in KNOBS}
    assert changed(scenario, places, places) is scenario


def test_a_slider_that_was_moved_changes_its_number_alone():
    scenario = load_scenario("line")
    before = {knob: knob.shown(scenario) for knob in KNOBS}
    other = changed(scenario, before | {DELTA: 500.0, STIFFNESS: 2.0}, before)
    assert (other.consensus.delta, other.springs.stiffness) == (500.0, 100.0)
    assert other.consensus.delta_v == scenario.consensus.delta_v


@pytest.mark.parametrize("knob", KNOBS)
def test_a_number_comes_back_from_its_slider(knob):
    scenario = load_scenario("line", overrides={knob.path: 1000.0})
    assert knob.value(knob.shown(scenario)) == pytest.approx(1000.0)


def test_numbers_that_differ_or_are_not_there_have_no_slider():
    scenario = load_scenario("line", overrides={"consensus": {"kind": "none"}, "springs.stiffness": {"1-2": 3.0}})
    assert [knob.shown(scenario) for knob in KNOBS] == [None, None, None]
