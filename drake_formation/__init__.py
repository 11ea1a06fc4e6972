"""Cooperative transport by hierarchical decentralized LQR, as a Drake block diagram.

Load a scenario, build its diagram, simulate it::

    from drake_formation import build_diagram, load_scenario, simulate

    scenario = load_scenario("line", overrides={"springs.stiffness": 3e4})
    diagram = build_diagram(scenario)  # a plain Drake Diagram
    result = simulate(scenario)  # a labelled xarray Dataset
"""

from drake_formation.check import Check, check
from drake_formation.diagram import build_diagram
from drake_formation.metrics import Metrics, metrics
from drake_formation.parameters import set_parameters
from drake_formation.scenario import Scenario, ScenarioError, load_scenario, with_overrides
from drake_formation.simulation import SimulationError, simulate

__all__ = [
    "Check",
    "Metrics",
    "Scenario",
    "ScenarioError",
    "SimulationError",
    "build_diagram",
    "check",
    "load_scenario",
    "metrics",
    "set_parameters",
    "simulate",
    "with_overrides",
]
