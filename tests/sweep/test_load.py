"""Sweep files: what ships loads, what is wrong is told with file and line."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sweep.quick import QUICK, quick_sweep

from drake_formation import load_scenario
from drake_formation.scenario import ScenarioError
from drake_formation.sweep import load_sweep, shipped_sweeps
from drake_formation.sweep.limits import MOST_POINTS

SOUND = """\
name: mine
scenario: line
set:
  aggregation.duration: 0.5
axes:
  - path: springs.stiffness
    values: [1.0, 2.0]
  - kind: zip
    values:
      consensus.delta: [0.0, 1.0]
      consensus.delta_v: [0.0, 2.0]
  - kind: list
    points:
      - label: a
        set: {robots.mass: 30.0}
  - kind: random
    seed: 1
    count: 3
    draw:
      avoidance.gain: {uniform: [1.0, 2.0]}
trajectories: {variables: [position], every: 0.5}
"""


@pytest.fixture
def faults(tmp_path):
    """What is said of a sweep file's text, without the folder."""

    def read(text):
        path = tmp_path / "mine.yaml"
        path.write_text(text)
        with pytest.raises(ScenarioError) as error:
            load_sweep(path)
        return str(error.value).replace(f"{tmp_path}/", "")

    return read


@pytest.mark.parametrize("name", shipped_sweeps())
def test_every_shipped_sweep_loads(name):
    sweep = load_sweep(name)
    assert sweep.name == name
    assert sweep.description
    assert sweep.text == shipped_sweeps()[name].read_text(encoding="utf-8")
    sweep.scenario(len(sweep) - 1)


def test_what_ships():
    assert {"gains", "topologies", "starts"} <= set(shipped_sweeps())


def test_a_file_with_every_kind_of_axis_loads(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(SOUND)
    sweep = load_sweep(path)
    assert sweep.shape == (2, 2, 1, 3)
    assert sweep.scenario(0).aggregation.duration == 0.5


def test_the_base_may_be_a_file_beside_the_sweep(tmp_path):
    (tmp_path / "base.yaml").write_text(Path(shipped_sweeps()["gains"]).parents[1].joinpath("line.yaml").read_text())
    (tmp_path / "mine.yaml").write_text(SOUND.replace("scenario: line", "scenario: base.yaml"))
    assert load_sweep(tmp_path / "mine.yaml").scenario(0).name == "line"


def test_the_base_may_be_a_scenario_from_python():
    scenario = load_scenario("line", overrides=QUICK)
    sweep = load_sweep(quick_sweep() | {"scenario": scenario, "set": {}})
    assert sweep.scenario(0) == load_sweep(quick_sweep()).scenario(0)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("name: mine", "name: mine\nexecutor: dask", "mine.yaml:2: executor: unknown key"),
        ("name: mine", "name: [1]", "mine.yaml:1: name: not allowed (got [1])"),
        ("name: mine\n", "", "name: missing"),
        ("scenario: line", f"scenario: {'x' * 300}", "mine.yaml:2: scenario: not a usable path: File name too long"),
        ("name: mine", f"name: {'x' * 300}", "mine.yaml:1: name: not allowed"),
        ("kind: list", f"kind: list\n    name: {'x' * 300}", "axes.2.name: not allowed"),
        ("uniform: [1.0, 2.0]", "uniform: [-1e308, 1e308]", "axes.3.draw.avoidance.gain.uniform: out of range"),
        ("values: [1.0, 2.0]", "linspace: [-1e308, 1e308, 3]", "mine.yaml:7: axes.0.linspace: out of range"),
        ("label: a", r'label: "a\0"', "mine.yaml:14: axes.2.points.0.label: not text"),
        ("label: a", r'label: "\ud83d"', "mine.yaml:14: axes.2.points.0.label: not text"),
        ("robots.mass: 30.0", f"robots.start.random.seed: 0x{'f' * 9000}", "mine.yaml:15"),
        ("aggregation.duration: 0.5", f"{'a.' * 200}a: 0.5", "mine.yaml:4"),
        ("scenario: line", "scenario: lime", "mine.yaml:2: scenario: no such file or shipped scenario (got lime)"),
        ("scenario: line", "scenario: lime", "did you mean 'line'?"),
        ("aggregation.duration: 0.5", "aggregation.durration: 0.5", "mine.yaml:4: aggregation.durration: unknown key"),
        ("aggregation.duration: 0.5", "aggregation.duration: -1.0", "mine.yaml:4: aggregation.duration: out of range"),
        ("aggregation.duration: 0.5", "aggregation.duration.x: 1.0", "mine.yaml:4: aggregation.duration.x"),
        ("aggregation.duration: 0.5", "a..b: 0.5", "mine.yaml:4: set.a..b: not a valid name"),
        ("springs.stiffness", "springs.stifness", "mine.yaml:7: springs.stifness: unknown key"),
        ("springs.stiffness", "springs.stifness", "did you mean 'stiffness'?"),
        ("[1.0, 2.0]\n  - kind: zip", "[1.0, -2.0]\n  - kind: zip", "mine.yaml:7: springs.stiffness: out of range"),
        ("values: [1.0, 2.0]", "valuess: [1.0, 2.0]", "mine.yaml:7: axes.0.valuess: unknown key"),
        ("values: [1.0, 2.0]", "valuess: [1.0, 2.0]", "did you mean 'values'?"),
        ("values: [1.0, 2.0]", "values: []", "mine.yaml:7: axes.0.values: too few entries"),
        ("values: [1.0, 2.0]", "linspace: [1.0, 2.0]", "mine.yaml:7: axes.0.linspace"),
        ("values: [1.0, 2.0]", "linspace: [1.0, -2.0, 3]", "mine.yaml:7: springs.stiffness: out of range (got -2.0)"),
        ("values: [1.0, 2.0]", "logspace: [0.0, 2.0, 3]", "mine.yaml:7: axes.0.logspace: out of range"),
        (
            "kind: zip",
            "kind: zap",
            "mine.yaml:8: axes.1.kind: unknown name (got zap); allowed: grid, zip, list, random",
        ),
        ("consensus.delta_v: [0.0, 2.0]", "consensus.delta_v: [0.0]", "mine.yaml:9: axes.1.values: not equally many"),
        ("consensus.delta_v: [0.0, 2.0]", "consensus.delta_v: [0.0, x]", "mine.yaml:11: consensus.delta_v"),
        ("consensus.delta_v: [", "springs.stiffness: [", "both set the same field"),
        ("consensus.delta_v: [", "springs: [", "both set the same field"),
        ("label: a", "lable: a", "mine.yaml:14: axes.2.points.0.lable: unknown key"),
        ("robots.mass: 30.0", "robots.mass: heavy", "mine.yaml:15: robots.mass"),
        ("count: 3", "count: 0", "mine.yaml:18: axes.3.count: out of range (got 0)"),
        ("uniform: [1.0, 2.0]", "unifrm: [1.0, 2.0]", "mine.yaml:20: axes.3.draw.avoidance.gain.unifrm: unknown key"),
        ("uniform: [1.0, 2.0]", "uniform: [2.0, 1.0]", "mine.yaml:20: axes.3.draw.avoidance.gain.uniform"),
        ("uniform: [1.0, 2.0]", "uniform: [-2.0, -1.0]", "mine.yaml:20: avoidance.gain: out of range"),
        ("kind: random", "kind: random\n    name: peak_force_n", "axes.3.name: taken by another part"),
        ("kind: list", "kind: list\n    name: case", "axes.2.name: taken by another part"),
        ("variables: [position]", "variables: [posision]", "mine.yaml:21: trajectories.variables.0: unknown name"),
        ("every: 0.5", "every: 0", "mine.yaml:21: trajectories.every: out of range"),
        ("every: 0.5", "evry: 0.5", "mine.yaml:21: trajectories.evry: unknown key"),
    ],
)
def test_a_wrong_file_is_refused_with_its_line(faults, old, new, message):
    assert old in SOUND
    assert message in faults(SOUND.replace(old, new, 1))


def test_every_wrong_value_is_told_once():
    wrong = {"path": "robots.mass", "values": [1.0, -1.0, -2.0]}
    with pytest.raises(ScenarioError) as error:
        load_sweep(quick_sweep({"path": "springs.stiffness", "values": [-3.0, 1.0]}, wrong))
    assert sorted(fault.value for fault in error.value.faults) == ["-1.0", "-2.0", "-3.0"]


def test_a_wrong_combination_is_the_runs_own_failure_unless_all_are_wrong():
    points = {"path": "robots.mass", "values": [40.0, [1.0, 2.0, 3.0]]}
    assert len(load_sweep(quick_sweep(points))) == 2
    with pytest.raises(ScenarioError, match=r"robots\.mass"):
        load_sweep(quick_sweep({"path": "robots.mass", "values": [[1.0], [1.0, 2.0, 3.0]]}))


def test_a_grid_of_billions_is_refused():
    axes = [{"path": path, "linspace": [0.0, 1.0, 10_000]} for path in ("consensus.delta", "consensus.delta_v")]
    with pytest.raises(ScenarioError, match=f"at most {MOST_POINTS}"):
        load_sweep(quick_sweep(*axes))


def contains_itself():
    data = quick_sweep()
    data["set"] = data
    return data


@pytest.mark.parametrize(
    "data", [contains_itself(), quick_sweep() | {"set": {(1, 2): 3}}, quick_sweep() | {"scenario": {"a": {(1,): 2}}}]
)
def test_what_is_no_plain_data_is_refused(data):
    with pytest.raises(ScenarioError, match="not plain data"):
        load_sweep(data)


def test_many_paths_are_compared_in_no_time():
    points = [{"label": str(k), "set": {f"robots.mass.{k}": 1.0}} for k in range(2000)]
    with pytest.raises(ScenarioError, match=r"robots\.mass and robots\.mass\.1999 both set the same field"):
        load_sweep(quick_sweep({"kind": "list", "points": points}, {"path": "robots.mass", "values": [1.0]}))


@pytest.mark.parametrize(("source", "message"), [("ganis", "did you mean 'gains'"), ("/", "a folder")])
def test_what_is_no_sweep_file_is_refused(source, message):
    with pytest.raises(ScenarioError, match=message):
        load_sweep(source)


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner, max_size=3),
    max_leaves=6,
)


def faults_of(sweep):
    """What is said of a sweep that is refused; nothing if it is not."""
    try:
        load_sweep(sweep)
    except ScenarioError as error:
        return [str(fault) for fault in error.faults]
    return None


@given(key=st.sampled_from(["name", "description", "scenario", "set", "axes", "trajectories"]), value=values)
def test_whatever_stands_in_a_file_is_loaded_or_refused(key, value):
    faults = faults_of(quick_sweep() | {key: value})
    assert faults is None or all(faults)


@given(
    kind=st.sampled_from(["grid", "zip", "list", "random"]),
    key=st.sampled_from(["name", "path", "values", "linspace", "labels", "points", "seed", "count", "draw"]),
    value=values,
)
def test_whatever_stands_in_an_axis_is_loaded_or_refused(kind, key, value):
    axes = {
        "grid": {"path": "springs.stiffness", "values": [1.0, 2.0]},
        "zip": {"values": {"springs.stiffness": [1.0]}},
        "list": {"points": [{"label": "a", "set": {"springs.stiffness": 1.0}}]},
        "random": {"seed": 1, "count": 2, "draw": {"springs.stiffness": {"uniform": [1.0, 2.0]}}},
    }
    faults = faults_of(quick_sweep(axes[kind] | {"kind": kind, key: value}))
    assert faults is None or all(faults)
