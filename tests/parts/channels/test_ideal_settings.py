"""Channels that are wires by their settings give the same bits as none: in runs, prepared runs and sweeps."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.analysis import linearize
from drake_formation.simulation import PreparedRun
from drake_formation.sweep import run_sweep

PLAIN = {
    "consensus.delta": 100.0,
    "consensus.delta_v": 60.0,
    "aggregation.duration": 0.5,
    "transport.duration": 0.5,
    "avoidance.obstacles": [],
}
WIRES = {"profile": {"kind": "packets", "profile": "ideal"}, "delay": {"kind": "delay", "delay": 0.0}}
ENGINES = ("blocks", "compiled", "exponential")


def scenario(wire=None):
    channel = {"consensus.channel": WIRES[wire]} if wire else {}
    return load_scenario("line", overrides=PLAIN | channel)


@pytest.mark.parametrize("engine", ENGINES)
def test_runs_and_prepared_runs_have_the_same_bits(engine):
    plain = simulate(scenario(), engine=engine)
    for wire in WIRES:
        run, prepared = simulate(scenario(wire), engine=engine), PreparedRun(scenario(wire), engine=engine)
        again = [prepared.run(scenario(wire)) for _ in range(2)]
        for name in ("time", "position", "velocity", "control_force"):
            np.testing.assert_array_equal(run[name], plain[name], err_msg=f"{wire}: {name}")
            for series in again:
                np.testing.assert_array_equal(series[name], plain[name], err_msg=f"{wire}, prepared: {name}")


def test_so_have_sweeps(tmp_path):
    channels = {"kind": "list", "points": [{"label": "none", "set": {}}]}
    channels["points"] += [{"label": name, "set": {"consensus.channel": wire}} for name, wire in WIRES.items()]
    sweep = {"name": "wires", "scenario": "line", "set": PLAIN, "axes": [channels]}
    with run_sweep(sweep, tmp_path, executor="serial", figures=False) as dataset:
        assert (dataset["status"] == 1).all()
        for name in ("consensus_error_m", "peak_force_n", "energy_j"):
            assert np.unique(dataset[name].values).size == 1


def test_a_wire_that_was_written_out_is_one_still():
    """As the analysis does, which puts a scenario at rest."""
    for wire in WIRES:
        np.testing.assert_array_equal(linearize(scenario(wire)).A, linearize(scenario()).A)
