import json
import sys
from pathlib import Path

import numpy as np
import pytest

from drake_formation import Scenario, SimulationError, check, load_scenario, metrics, simulate, with_overrides
from drake_formation.measuring.check import position_difference, tightened
from drake_formation.simulation.result import series_of

SHORT = {"aggregation.duration": 1.0, "transport.duration": 3.0}


def buckling():
    """Three robots pressed together along a line by hard springs: whatever they are off the line by, grows."""
    return Scenario.model_validate(
        {
            "name": "buckling",
            "formation": {"shape": "line", "robots": 3, "side": 1.0, "heading": 0.0},
            "robots": {"start": [[-0.6, 0.0], [0.0, 1e-3], [0.6, 0.0]], "mass": [20.0, 40.0, 80.0]},
            "springs": {"graph": [[1, 2], [2, 3]], "stiffness": 1e4},
            "consensus": {"graph": [[1, 2], [2, 3]]},
            "transport": {"goal": [0.0, 0.0], "duration": 10.0},
        }
    )


@pytest.mark.slow
def test_a_run_that_amplifies_its_errors_is_found_out():
    scenario = buckling()
    result = simulate(scenario, engine="compiled")
    truth = simulate(with_overrides(scenario, {"simulator.accuracy": 1e-11}), engine="compiled")
    error = position_difference(series_of(result), series_of(truth))
    assert error > 1e4 * scenario.simulator.accuracy
    found = check(scenario, result)
    assert found.position_difference_m == pytest.approx(error, rel=0.05)
    assert found.accuracy == pytest.approx(1e-8)
    assert found.max_step_size == 0.025


def test_a_run_that_forgets_its_errors_is_confirmed():
    scenario = load_scenario("line", overrides=SHORT)
    found = check(scenario, simulate(scenario))
    assert 0 < found.position_difference_m < 1e-4
    assert found.metrics["consensus_error_m"] < 1e-4
    assert len(found.metrics["tracking_error_m"]) == 2
    assert found.metrics["settling_time_s"] is None
    assert found.engine == "blocks"


def test_metrics_differ_by_what_they_differ_by():
    scenario = load_scenario("line", overrides=SHORT | {"simulator.accuracy": 1e-3})
    result = simulate(scenario)
    second = metrics(simulate(tightened(scenario)))
    found = check(scenario, result)
    assert found.metrics["consensus_error_m"] == abs(metrics(result).consensus_error_m - second.consensus_error_m) > 0


def test_positions_are_compared_between_samples_too():
    """The same motion at other samples is the same."""
    scenario = load_scenario("line", overrides=SHORT | {"simulator.accuracy": 1e-10})
    coarse, fine = (
        series_of(simulate(with_overrides(scenario, {"simulator.max_step_size": step}), engine="compiled"))
        for step in (0.1, 0.007)
    )
    assert position_difference(coarse, fine) < 1e-8
    moved = series_of(simulate(with_overrides(scenario, {"robots.mass": 40.001}), engine="compiled"))
    ends = np.abs(moved["position"][-1] - coarse["position"][-1]).max()
    assert position_difference(coarse, moved) >= ends > 1e-6


def test_fixed_steps_become_shorter():
    overrides = {"simulator.integration_scheme": "explicit_euler", "simulator.max_step_size": 0.01}
    scenario = load_scenario("line", overrides=SHORT | overrides)
    found = check(scenario, simulate(scenario))
    assert found.max_step_size == 0.0025
    assert found.position_difference_m > 1e-4


def test_the_finest_accuracy_is_left_as_it_is():
    for given, wanted in ((1e-6, 1e-8), (1e-11, 1e-12), (1e-13, 1e-13)):
        scenario = load_scenario("line", overrides={"simulator.accuracy": given})
        assert tightened(scenario).simulator.accuracy == pytest.approx(wanted)


ARGUMENTS = ["--set", "aggregation.duration=1", "--set", "transport.duration=2"]


def test_the_command_says_what_changes(cli):
    status, out, _ = cli("run", "line", *ARGUMENTS, "--check", "--out", "o")
    assert status == 0
    assert "check differs by" in out
    assert "positions at any time" in out
    figures = json.loads(Path("o/metrics.json").read_text())
    assert 0 < figures["check"]["position_difference_m"] < 1e-4
    assert figures["check"]["metrics"].keys() == figures.keys() - {"check", "events"}
    assert [path.name for path in Path("o").iterdir() if path.name.startswith(".")] == []


def test_a_check_that_fails_leaves_the_run(cli, monkeypatch):
    def fail(scenario, result, progress):
        raise SimulationError("the second run stopped", 1.0, 1, result)

    monkeypatch.setattr(sys.modules["drake_formation.measuring.check"], "check", fail)
    status, _, err = cli("run", "line", *ARGUMENTS, "--check", "--out", "o")
    assert status == 3
    assert "its check is not: the second run stopped" in err
    assert Path("o/result.nc").exists()
    assert "check" not in json.loads(Path("o/metrics.json").read_text())
    assert not Path("o.failed").exists()


def test_the_command_names_the_engine(cli):
    _, out, _ = cli("run", "line", *ARGUMENTS, "--out", "o")
    assert "engine blocks: done in some" in " ".join(out.split())
    _, out, _ = cli("run", "line", *ARGUMENTS, "--engine", "compiled", "--out", "o")
    assert "engine compiled: as asked for" in out
