"""Another package's parts: found by their entry points, run on every engine, swept and certified."""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import xarray as xr

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
    {
        "consensus": {"kind": "leader_follower", "channel": {"kind": "lag", "time_constant": 0.1}},
        "tracking": {"kind": {1: "lqr", "default": "none"}},
    },
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
measured = metrics(simulate(load_scenario("line", overrides=short)))
assert len(measured["mean_consensus_error_m"]) == 2
assert 0 < max(measured.mean_consensus_error_m) < measured.consensus_error_m
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


def announce(installed, group, entry):
    points = installed / "entry_points.txt"
    head = f"[drake_formation.{group}]\n"
    points.write_text(points.read_text().replace(head, f"{head}{entry}\n"))


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
    with xr.open_dataset(tmp_path / "out" / "sweep.nc") as dataset:
        metric = dataset["mean_consensus_error_m"].load()
    assert metric.dims == ("cubic", "robot")
    assert metric.attrs["units"] == "m"
    assert (metric > 0).all()


@pytest.mark.usefixtures("installed")
def test_its_metric_is_listed_with_what_brings_it():
    result = ran("-m", "drake_formation", "list", "metrics")
    assert "mean_consensus_error_m" in result.stdout
    assert "formation-extras" in result.stdout


def test_a_metric_that_cannot_be_used_is_told_of_and_costs_no_other(installed):
    announce(installed, "metrics", "consensus = drake_formation.measuring.consensus_error:consensus_error")
    result = ran("-m", "drake_formation", "list", "metrics")
    assert result.returncode == 0
    assert "metric 'consensus' of formation-extras cannot be used: drake-formation has a metric" in result.stderr
    assert "mean_consensus_error_m" in result.stdout


@pytest.mark.slow
def test_a_sweep_notices_that_another_packages_code_has_changed(installed, tmp_path, monkeypatch):
    (tmp_path / "formation_extras").unlink()
    shutil.copytree(EXAMPLE / "formation_extras", tmp_path / "formation_extras")
    (tmp_path / "extras.yaml").write_text(SWEEP)
    monkeypatch.chdir(tmp_path)
    sweep = ("-m", "drake_formation", "sweep", "extras.yaml", "--out", "out", "--executor=serial")
    assert ran(*sweep).returncode == 0
    law = tmp_path / "formation_extras" / "stiffening.py"
    law.write_text(law.read_text().replace("tension = stiffness", "tension = 2 * stiffness"))
    result = ran(*sweep)
    assert result.returncode == 2
    assert "formation_extras code" in result.stderr


def test_a_part_that_cannot_be_imported_is_told_of_when_it_is_asked_for(installed):
    announce(installed, "parts", "broken = formation_extras.missing:Missing")
    assert ran("-m", "drake_formation", "validate", "line").returncode == 0
    result = ran("-m", "drake_formation", "validate", "line", "--set", "tracking.kind=broken")
    assert result.returncode == 2
    assert "part 'broken' of formation-extras cannot be used" in result.stderr


def test_two_parts_of_one_name_are_told_of_when_they_are_asked_for(installed):
    announce(installed, "parts", "hookean = drake_formation.parts.springs.hookean:Hookean")
    result = ran("-m", "drake_formation", "validate", "line", "--set", "springs.law=hookean")
    assert result.returncode == 2
    assert "spring 'hookean' is in drake-formation and in formation-extras" in result.stderr


def test_a_role_of_many_is_no_place_for_a_broken_part_of_another(installed):
    announce(installed, "parts", "no_part = formation_extras.stiffening:NonNegative")
    result = ran("-m", "drake_formation", "validate", "line", "--set", "tracking.kind=no_part")
    assert result.returncode == 2
    assert "is no part" in result.stderr
