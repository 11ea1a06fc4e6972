import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios
from sweep.quick import QUICK

from drake_formation import load_scenario, metrics, simulate
from drake_formation.sweep import runner as module
from drake_formation.sweep.runner import Runner
from drake_formation.sweep.schema import Trajectories

RING = load_scenario("quadrilateral", overrides=QUICK | {"consensus.graph": "cycle", "consensus.delta": 10.0})
LINE = load_scenario("line", overrides=QUICK)


def equal(first, second):
    assert list(first) == list(second)
    for name, value in first.items():
        np.testing.assert_array_equal(value, second[name])


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_values_are_the_metrics_of_a_simulation(engine):
    values = Runner(engine, None).measure(LINE)
    wanted = metrics(simulate(LINE, engine=engine)).to_dict()
    equal(values, {name: np.array(np.nan if x is None else x, dtype=float) for name, x in wanted.items()})


@settings(max_examples=15)
@given(st.data())
def test_what_ran_before_makes_no_difference(data):
    runner = _WARM
    scenario = data.draw(scenarios())
    runner.measure(data.draw(st.sampled_from([LINE, RING])))
    equal(runner.measure(scenario), Runner("blocks", None).measure(scenario))


_WARM = Runner("blocks", None)


@pytest.mark.slow
def test_a_diagram_is_built_once_for_each_structure():
    runner = Runner("compiled", None)
    for scenario in (LINE, RING, LINE, LINE, RING):
        runner.measure(scenario)
    assert runner.built == 2


def test_no_more_diagrams_are_kept_than_allowed(monkeypatch):
    monkeypatch.setattr(module, "STRUCTURES", 1)
    runner = Runner("compiled", None)
    first = runner.measure(LINE)
    runner.measure(RING)
    equal(runner.measure(LINE), first)
    assert runner.built == 3


def test_time_series_come_with_the_metrics():
    values = Runner("compiled", Trajectories(variables=("position", "control_force"), every=0.25)).measure(LINE)
    assert values["position"].shape == values["control_force"].shape == (5, 2, 2)
