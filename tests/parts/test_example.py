"""Another package's parts: found by their entry points, run on every engine, swept and certified."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).parents[1] / "example_parts"

PROGRAM = """
import numpy as np

from drake_formation import load_scenario, metrics, simulate
from drake_formation.analysis import certify
from drake_formation.parts import find
from drake_formation.scenario import to_yaml, json_schema
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate

assert find("spring", "stiffening").distribution == "formation-extras"
assert "stiffening" in str(json_schema())
short = {"transport.duration": 3.0, "aggregation.duration": 1.0}
cases = [
    {"springs": {"law": "stiffening", "stiffness": 20.0, "cubic": 5.0}},
    {"tracking": {"kind": {1: "sliding_mode", "default": "lqr"}, "gain": {1: 50.0}, "Q": 2.0}},
    {"consensus": {"delta": 20.0, "channel": {"kind": "lag", "time_constant": 0.1}}},
]
for case in cases:
    scenario = load_scenario("line", overrides={**short, **case})
    assert validate(parse(to_yaml(scenario), "again.yaml")) == scenario
    engines = ("blocks", "compiled", "exponential")
    ends = [simulate(scenario, engine=engine)["position"].values[-1] for engine in engines]
    assert np.ptp(ends, axis=0).max() < 1e-3, case
laws = {"springs": {"law": "stiffening", "stiffness": 20.0}, "tracking": {"kind": "sliding_mode"}}
certificate = certify(load_scenario("line", overrides={**laws, "consensus.delta": 10.0}))
assert certificate.stable
assert "sliding_mode" in str(certificate.unanswered["local"]), certificate.unanswered
print("all good")
"""

SWEEP = """
name: extras
scenario: line
set: {transport.duration: 2.0, aggregation.duration: 1.0, springs: {law: stiffening, stiffness: 3.0}}
axes:
  - path: springs.cubic
    values: [0.0, 1.0, 2.0]
"""


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """The example as it stands in a folder of installed packages: its modules, and what says its entry points."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    info = tmp_path / "formation_extras-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n")
    lines = [f"[{group}]\n" + "\n".join(f"{k} = {v}" for k, v in its.items()) for group, its in
             project["entry-points"].items()]  # fmt: skip
    (info / "entry_points.txt").write_text("\n".join(lines) + "\n")
    (tmp_path / "formation_extras").symlink_to(EXAMPLE / "formation_extras")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", "")]))
    return info


def ran(*arguments):
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False)


@pytest.mark.slow
@pytest.mark.usefixtures("installed")
def test_its_parts_run_on_every_engine_and_are_certified():
    result = ran("-c", PROGRAM)
    assert result.stdout == "all good\n", result.stderr


@pytest.mark.slow
@pytest.mark.usefixtures("installed")
def test_its_parts_are_swept_in_workers(tmp_path):
    (tmp_path / "extras.yaml").write_text(SWEEP)
    sweep, out = str(tmp_path / "extras.yaml"), str(tmp_path / "out")
    result = ran("-m", "drake_formation", "sweep", sweep, "--out", out, "--workers", "2")
    assert result.returncode == 0, result.stderr
    assert (tmp_path / "out" / "sweep.nc").exists()


def test_a_part_that_cannot_be_imported_is_told_of_when_it_is_asked_for(installed):
    points = installed / "entry_points.txt"
    points.write_text(points.read_text() + "broken = formation_extras.missing:Missing\n")
    assert ran("-m", "drake_formation", "validate", "line").returncode == 0
    result = ran("-m", "drake_formation", "validate", "line", "--set", "tracking.kind=broken")
    assert result.returncode == 2
    assert "part 'broken' of formation-extras cannot be used" in result.stderr


def test_two_parts_of_one_name_are_told_of_when_they_are_asked_for(installed):
    points = installed / "entry_points.txt"
    points.write_text(points.read_text() + "hookean = drake_formation.parts.springs.hookean:Hookean\n")
    result = ran("-m", "drake_formation", "validate", "line", "--set", "springs.law=hookean")
    assert result.returncode == 2
    assert "spring 'hookean' is in drake-formation and in formation-extras" in result.stderr


def test_a_role_of_many_is_no_place_for_a_broken_part_of_another(installed):
    points = installed / "entry_points.txt"
    points.write_text(points.read_text() + "no_part = formation_extras.stiffening:NonNegative\n")
    result = ran("-m", "drake_formation", "validate", "line", "--set", "tracking.kind=no_part")
    assert result.returncode == 2
    assert "is no part" in result.stderr
