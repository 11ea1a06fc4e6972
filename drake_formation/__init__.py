"""Cooperative transport by hierarchical decentralized LQR, as a Drake block diagram.

Load a scenario, build its diagram, simulate it::

    from drake_formation import build_diagram, load_scenario, simulate

    scenario = load_scenario("line", overrides={"springs.stiffness": 3e4})
    diagram = build_diagram(scenario)  # a plain Drake Diagram
    result = simulate(scenario)  # a labelled xarray Dataset
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from drake_formation.diagram import build_diagram
    from drake_formation.measuring import Metrics, metrics
    from drake_formation.measuring.check import Check, check
    from drake_formation.parameters import set_parameters
    from drake_formation.results import load_result
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
    "load_result",
    "load_scenario",
    "metrics",
    "set_parameters",
    "simulate",
    "with_overrides",
]

_HOMES = {
    "build_diagram": "diagram",
    "load_result": "results",
    "set_parameters": "parameters",
    **dict.fromkeys(["Scenario", "ScenarioError", "load_scenario", "with_overrides"], "scenario"),
    **dict.fromkeys(["SimulationError", "simulate"], "simulation"),
    **dict.fromkeys(["Metrics", "metrics"], "measuring"),
    **dict.fromkeys(["Check", "check"], "measuring.check"),
}


def __getattr__(name: str) -> Any:
    """What is slow to import (Drake is) is imported where it is first asked for."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
