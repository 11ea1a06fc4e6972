"""One diagram runs many scenarios, each as if it were alone."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import HealthCheck, given, settings
from strategies import pairs_of_scenarios

from drake_formation import load_scenario, metrics, simulate, with_overrides
from drake_formation.measuring import measure
from drake_formation.simulation import PreparedRun
from drake_formation.simulation.result import labelled_result

SHORT = {"aggregation.duration": 1.0, "transport.duration": 2.0}


@pytest.fixture(params=["blocks", "compiled"])
def engine(request):
    return request.param


@pytest.mark.slow
@given(pair=pairs_of_scenarios())
@settings(max_examples=3, deadline=None, suppress_health_check=list(HealthCheck))
def test_a_run_does_not_depend_on_what_ran_before(pair):
    first, second = pair
    prepared = PreparedRun(first, engine="compiled")
    prepared.run(first)
    again, alone = prepared.run(second), PreparedRun(second, engine="compiled").run(second)
    for name, values in alone.items():
        np.testing.assert_array_equal(again[name], values, err_msg=name)


def test_other_numbers_starts_and_times_give_what_they_give_alone(engine):
    base = load_scenario("line", overrides=SHORT)
    other = with_overrides(
        base, {"springs.stiffness": 50.0, "robots.start": [[0.0, 1.0], [2.0, 2.0]], "simulator.max_step_size": 0.05}
    )
    prepared = PreparedRun(base, engine=engine)
    prepared.run(base)
    series, alone = prepared.run(other), simulate(other, engine=engine)
    xr.testing.assert_identical(labelled_result(series), alone)
    assert measure(series) == metrics(alone)


def test_another_structure_is_refused(engine):
    base = load_scenario("line", overrides=SHORT)
    with pytest.raises(ValueError, match="structure"):
        PreparedRun(base, engine=engine).run(with_overrides(base, {"avoidance.obstacles": []}))


def test_an_unknown_engine_is_named():
    with pytest.raises(ValueError, match="auto, blocks, compiled"):
        PreparedRun(load_scenario("line"), engine="steam")
