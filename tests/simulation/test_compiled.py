"""The compiled engine gives the results of the blocks."""

import numpy as np
import pytest

from drake_formation import ScenarioError, SimulationError, load_scenario, metrics, simulate

SHORT = {"aggregation.duration": 2.0, "transport.duration": 6.0, "simulator.accuracy": 1e-8}


@pytest.mark.parametrize("name", ["line", "quadrilateral"])
def test_same_result(name):
    scenario = load_scenario(name, overrides=SHORT)
    found, expected = (simulate(scenario, engine=engine) for engine in ("compiled", "blocks"))
    assert found.sizes.keys() == expected.sizes.keys()
    assert {key: value.dims for key, value in found.variables.items()} == {
        key: value.dims for key, value in expected.variables.items()
    }
    assert np.diff(found["time"]).max() <= scenario.simulator.max_step_size * (1 + 1e-12)
    for time in (2.0, 8.0):
        for variable in ("position", "velocity", "control_force", "phase"):
            np.testing.assert_allclose(
                found[variable].sel(time=time), expected[variable].sel(time=time), rtol=0, atol=1e-4
            )


def test_the_published_line():
    figures = metrics(simulate(load_scenario("line"), engine="compiled"))
    np.testing.assert_allclose(figures.tracking_error_m, [0.1868, 0.1686], rtol=0, atol=1e-4)
    assert figures.consensus_error_m == pytest.approx(0.0961, abs=1e-4)
    assert figures.peak_force_n == pytest.approx(22.5, abs=1e-2)


def test_another_integrator_is_refused():
    scenario = load_scenario("line", overrides={"simulator.integration_scheme": "runge_kutta3"})
    with pytest.raises(ScenarioError, match="integration_scheme"):
        simulate(scenario, engine="compiled")


@pytest.mark.slow
def test_the_exponential_engine_refuses_a_force_that_jumps_before_it_runs():
    scenario = load_scenario("line", overrides={"avoidance.sensing": "nearest"})
    with pytest.raises(ScenarioError, match=r"avoidance.sensing: .*nearest.*allowed: in_range, or the engine compiled"):
        simulate(scenario, engine="exponential")
    for none in ({"avoidance.obstacles": []}, {"avoidance.gain": 0.0}):
        simulate(load_scenario("line", overrides={"avoidance.sensing": "nearest", **none}), engine="exponential")


def test_a_run_that_diverges_keeps_what_was_recorded():
    overrides = {"consensus.delta": 1e8, "simulator.use_error_control": False, "aggregation.duration": 1.0}
    with pytest.raises(SimulationError, match="no longer finite") as caught:
        simulate(load_scenario("line", overrides=overrides), engine="compiled")
    assert caught.value.partial.sizes["time"] > 1
    assert np.isfinite(caught.value.partial["position"]).all()


def test_a_run_that_error_control_would_follow_in_ever_shorter_steps_is_given_up():
    """Commands held for half a second are far too late for such gains."""
    held = {"kind": "packets", "period": 0.5}
    overrides = {"consensus.delta": 1e4, "consensus.channel": held, "avoidance.obstacles": []}
    with pytest.raises(SimulationError, match=r"its state grew beyond 1e\+12") as caught:
        simulate(load_scenario("line", overrides=overrides), engine="compiled")
    last = np.abs(caught.value.partial["velocity"].values[-1]).max()
    assert last > 1e6


@pytest.mark.parametrize("name", ["line", "quadrilateral"])
def test_the_exponential_engine_passes_through_the_same_states(name):
    scenario = load_scenario(name, overrides=SHORT)
    found, expected = (simulate(scenario, engine=engine) for engine in ("exponential", "compiled"))
    for time in (2.0, 8.0):
        for variable in ("position", "control_force", "phase", "deviation"):
            np.testing.assert_allclose(
                found[variable].sel(time=time), expected[variable].sel(time=time), rtol=0, atol=1e-4
            )
    np.testing.assert_allclose(metrics(found).tracking_error_m, metrics(expected).tracking_error_m, rtol=0, atol=1e-4)
