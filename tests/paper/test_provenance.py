"""Parameters in the report are those of the scenarios that run."""

import pytest

from drake_formation.paper import runs
from drake_formation.paper.provenance import SCENARIOS, provenance
from drake_formation.paper.published import published
from drake_formation.paper.readings.two_readings import PRINTED
from drake_formation.scenario import load_scenario


@pytest.fixture
def other_scenarios(monkeypatch):
    """Scenarios with other numbers than the shipped ones."""
    changed = {"robots.mass": 41.0, "avoidance.range": 1.25, "aggregation.duration": 33.0}
    monkeypatch.setattr(runs, "shipped", lambda name: load_scenario(name, overrides=changed))


def row(parameter):
    (line,) = [line for line in provenance().splitlines() if line.startswith(f"| {parameter}")]
    return line.split(" | ")


def test_a_number_that_is_changed_in_a_scenario_changes_the_report(other_scenarios):
    assert row("mass")[1] == "41 kg"
    assert row("sensing range ρ0")[1] == "1.25 m"
    assert row("aggregation time T_agg")[1] == "33 s"


def test_the_shipped_numbers():
    assert row("mass")[1:3] == ["40 kg", "40 kg"]
    assert row("aggregation time T_agg")[1:3] == ["60, 30, 40 s", "60, 52, 71 s"]
    assert row("who feels")[1] == "the nearest robot, within ρ0"


def test_every_parameter_has_a_provenance():
    for *_, source in SCENARIOS:
        assert any(word in source for word in ("published", "inferred", "chosen"))


def test_what_is_called_published_is():
    scenario = PRINTED.transport("line", "rubber", 0.0)
    assert scenario.robots.mass == published()["robot_mass_kg"]
    assert [list(obstacle.position) for obstacle in scenario.avoidance.obstacles] == published()["obstacles_m"]
