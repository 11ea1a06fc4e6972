"""Scenarios: what a user writes, checked before Drake sees it."""

from drake_formation.config.errors import Fault, ScenarioError
from drake_formation.scenario.export import dump_scenario, json_schema, to_yaml
from drake_formation.scenario.load import load_scenario, shipped_scenarios, with_overrides
from drake_formation.scenario.resolve import resolve, warnings
from drake_formation.scenario.schema import Scenario

__all__ = [
    "Fault",
    "Scenario",
    "ScenarioError",
    "dump_scenario",
    "json_schema",
    "load_scenario",
    "resolve",
    "shipped_scenarios",
    "to_yaml",
    "warnings",
    "with_overrides",
]
