"""Trajectories of an independent solver (DOP853 at 1e-10), which lie beside the repository."""

from pathlib import Path

import numpy as np
import pytest
from probe import state_of
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from ruamel.yaml import YAML

from drake_formation.diagram import build_diagram
from drake_formation.scenario import Scenario

REFERENCE = Path(__file__).parents[3] / "shared" / "reference"

CASES = ["line-rubber-local", "line-steel-consensus", "square-rubber-displaced", "triangle-linear-path"]


@pytest.fixture(params=CASES)
def case(request):
    if not REFERENCE.is_dir():
        pytest.skip("the reference trajectories are not beside the repository")
    parameters = YAML(typ="safe").load(REFERENCE / "cases.yaml")[request.param]
    table = np.loadtxt(REFERENCE / f"{request.param}.csv", delimiter=",", skiprows=1)
    return parameters, table[:, 0], table[:, 1:]


def scenario_of(parameters):
    return Scenario.model_validate(
        {
            "name": "reference",
            "formation": {"shape": "slots", "slots": parameters["slots"]},
            "robots": {"start": parameters["start"], "mass": 40.0},
            "springs": {"law": parameters["spring_law"], "stiffness": parameters["stiffness"]},
            "consensus": {
                "graph": parameters["consensus_edges"],
                "delta": parameters["delta"],
                "delta_v": parameters["delta_v"],
            },
            "avoidance": {
                "obstacles": [{"position": [6.0, 5.05]}, {"position": [20.0, 1.9]}],
                "range": 1.3,
                "gain": 31.56,
            },
            "transport": {"goal": parameters["goal"]},
            "simulator": {"accuracy": 1e-9},
        }
    )


def test_an_independent_solver_agrees_to_ten_micrometres(case):
    parameters, times, expected = case
    scenario = scenario_of(parameters)
    simulator = Simulator(build_diagram(scenario))
    ApplySimulatorConfig(SimulatorConfig(**scenario.simulator.model_dump()), simulator)
    for time, state in zip(times, expected, strict=True):
        simulator.AdvanceTo(time)
        np.testing.assert_allclose(state_of(simulator.get_context()).ravel(), state, rtol=0, atol=1e-5, err_msg=time)
