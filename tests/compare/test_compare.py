"""One scenario under several laws: the same runs as each law makes alone, and a table that reads like a paper's."""

import csv
import io
import json
import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread
from ruamel.yaml import YAML

from drake_formation import ScenarioError, load_scenario, metrics, simulate
from drake_formation.compare import load_comparison, rows, run_comparison, shipped_comparisons
from drake_formation.compare.run import run_one, traffic
from drake_formation.compare.table import COLUMNS, as_csv, latex, markdown
from drake_formation.parts import part, register, registry
from drake_formation.parts.tracking.lqr import Lqr
from drake_formation.scenario import resolve

FILE = """\
name: small
scenario: line
set:
  aggregation.duration: 1.0
  transport.duration: 2.0
  robots.start: {random: {about: [2.5, 3.5], spread: 1.0, seed: 1}}
laws:
  - name: consensus
    set: {consensus.delta: 100.0}
  - name: "none & nothing"
    set: {consensus: {kind: none}}
cases:
  - name: rubber
  - name: steel
    set: {springs.stiffness: 1.0e+3}
seeds: [3, 5]
"""


@pytest.fixture
def written(tmp_path):
    def write(text=FILE):
        path = tmp_path / "small.yaml"
        path.write_text(text)
        return path

    return write


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    path = tmp_path_factory.mktemp("compare") / "small.yaml"
    path.write_text(FILE)
    comparison = load_comparison(path)
    outcomes = run_comparison(comparison)
    return comparison, outcomes, rows(comparison, outcomes)


def test_every_law_has_the_same_starts_and_cases(small):
    comparison, _, _ = small
    assert len(comparison.runs) == 8
    starts = {}
    for run in comparison.runs:
        starts.setdefault(run.seed, []).append(simulate(run.scenario)["position"].values[0])
    for places in starts.values():
        assert np.ptp(places, axis=0).max() == 0
    assert np.abs(starts[3][0] - starts[5][0]).max() > 0.01


def test_its_figures_are_those_of_each_law_alone(small):
    comparison, outcomes, table = small
    for run, outcome in zip(comparison.runs, outcomes, strict=True):
        assert outcome.metrics == metrics(simulate(run.scenario)).to_dict()
    own = [o.metrics["peak_force_n"] for o in outcomes if (o.run.case, o.run.law) == ("steel", "consensus")]
    (row,) = (row for row in table if (row.case, row.law) == ("steel", "consensus"))
    assert row.cells["peak_force_n"].mean == pytest.approx(np.mean(own))
    assert row.cells["peak_force_n"].spread == pytest.approx(np.std(own, ddof=1))


def test_a_case_changes_what_a_law_has_put_in_place(written):
    law = "avoidance: {kind: rotational}"
    text = FILE.replace("consensus: {kind: none}", law).replace(
        "springs.stiffness: 1.0e+3", "avoidance.obstacles: [{position: [9.0, 9.0]}]"
    )
    run = load_comparison(written(text)).runs[-1]
    assert resolve(run.scenario).parts["avoidance"][0].kind == "rotational"
    assert resolve(run.scenario).obstacles.discs[:, :2].tolist() == [[9.0, 9.0]]


def test_a_mapping_says_what_a_file_says(written):
    mapping = YAML(typ="safe").load(FILE) | {"scenario": load_scenario("line")}
    assert load_comparison(mapping) == load_comparison(written())
    del mapping["laws"]
    with pytest.raises(ScenarioError, match="the comparison: laws: missing"):
        load_comparison(mapping)


@pytest.fixture
def registered():
    """A part that only this process knows."""

    class Halved(Lqr):
        def gain(self, mass):
            return super().gain(mass) / 2

    yield register(part("tracking", kind="halved")(Halved))
    del registry._parts["tracking"]["halved"]
    registry._told()


@pytest.mark.usefixtures("registered")
def test_a_part_of_this_session_is_compared(written):
    laws = [{"name": "halved", "set": {"tracking": {"kind": "halved"}}}]
    short = {"aggregation.duration": 0.0, "transport.duration": 2.0, "robots.start": {"centre": [2.5, 3.5]}}
    told = []
    comparison = load_comparison({"name": "mine", "scenario": "line", "set": short, "laws": laws})
    (outcome,) = run_comparison(comparison, progress=lambda *done: told.append(done))
    assert outcome.metrics["peak_force_n"] == pytest.approx(22.5 / 2)
    assert told == [(0, 1), (1, 1)]


def test_channels_count_where_they_are_read(small):
    _, _, table = small
    assert {row.law: (row.channels, row.messages) for row in table} == {
        "consensus": (2, math.inf),
        "none & nothing": (0, 0.0),
    }


def test_a_sampled_law_sends_as_often_as_it_samples(written):
    law = "consensus: {kind: mpc, graph: complete, period: 0.5}, tracking: {kind: none}"
    comparison = load_comparison(written(FILE.replace("consensus: {kind: none}", law)))
    assert traffic(comparison.runs[2]) == (2, 4.0)


def test_the_best_of_a_column_is_in_bold_once(small):
    comparison, _, table = small
    for case in comparison.cases:
        for name in COLUMNS:
            own = [row.cells[name] for row in table if row.case == case]
            best = [cell for cell in own if cell.best]
            worst = min if name == "min_clearance_m" else max
            assert len(best) <= 1
            assert all(cell.mean != worst(other.mean for other in own) for cell in best)
    text = markdown(comparison, table)
    best = sum(cell.best for row in table for cell in row.cells.values())
    assert text.count("**") // 2 == best + len(comparison.cases)


def test_the_tables_say_the_same(small):
    comparison, _, table = small
    read = list(csv.DictReader(io.StringIO(as_csv(table))))
    assert [float(line["rms_force_n"]) for line in read] == [row.cells["rms_force_n"].mean for row in table]
    tabular = latex(comparison, table)
    assert tabular.count(r"\\") == 1 + len(comparison.cases) + len(table)
    assert r"none \& nothing" in tabular
    for row in table:
        assert row.cells["rms_force_n"].text().split(" ")[0] in tabular


def test_a_law_that_fails_is_told_of_and_wins_nothing(small):
    comparison, outcomes, _ = small
    failing = [replace(o, metrics={}, failure="it diverged") if o.run.law == "consensus" else o for o in outcomes]
    table = rows(comparison, failing)
    assert all(not cell.best for row in table if row.law == "consensus" for cell in row.cells.values())
    assert "| – |" in markdown(comparison, table)
    assert "0 of 2" in markdown(comparison, table)


def test_a_run_that_diverges_is_an_outcome(written):
    euler = "simulator.use_error_control: false, simulator.integration_scheme: explicit_euler"
    text = FILE.replace(
        "set: {consensus: {kind: none}}",
        f"set: {{consensus.delta: 1.0e+6, avoidance.obstacles: [], transport.duration: 60.0, {euler}}}",
    )
    outcome = run_one(load_comparison(written(text)).runs[2])
    assert "no longer finite" in outcome.failure or "stopped" in outcome.failure
    assert not outcome.metrics


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("consensus.delta: 100.0", "consensus.dleta: 100.0", r"small\.yaml:9: consensus\.dleta: unknown key"),
        ("kind: none", "kind: nnoe", r"small\.yaml:11: consensus\.kind: .*did you mean 'none'"),
        ("scenario: line", "scenario: lien", r"small\.yaml:2: scenario: no such file or shipped scenario .*'line'"),
        ("name: steel", "name: rubber", r"small\.yaml:14: cases\.1\.name: another one has this name"),
        ("laws:", "rules:", r"small\.yaml:\d+: rules: unknown key; allowed: name, "),
        ("springs.stiffness: 1.0e+3", "consensus: {kind: none}", r":15: cases.1.set.consensus: replaces what law"),
        ("seeds: [3, 5]", "seeds: [-1]", r"small\.yaml:16: seeds\.0: "),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_with_file_and_line(written, old, new, said):
    with pytest.raises(ScenarioError, match=said):
        load_comparison(written(FILE.replace(old, new)))


@pytest.mark.parametrize("name", shipped_comparisons())
def test_the_shipped_ones_are_sound(name):
    comparison = load_comparison(name)
    assert len(comparison.runs) % (len(comparison.laws) * len(comparison.cases)) == 0
    assert comparison.description


@pytest.mark.slow
def test_the_command_leaves_tables_figures_and_scenarios(cli, written, tmp_path):
    out = tmp_path / "out"
    status, said, _ = cli("compare", written(), "--out", out)
    assert status == 0
    assert "small, rubber" in said
    assert "Tables in" in said
    assert sorted(path.name for path in out.iterdir()) == [
        "figures", "runs.json", "scenarios", "table.csv", "table.md", "table.tex",
    ]  # fmt: skip
    assert {path.name for path in (out / "figures").iterdir()} == {
        "consensus_error.png", "error_against_effort.png", "paths.png",
    }  # fmt: skip
    assert all(imread(path).std() > 0.01 for path in (out / "figures").iterdir())
    runs = json.loads((out / "runs.json").read_text())
    again = simulate(load_scenario(out / runs[0]["scenario"]))
    assert metrics(again).to_dict() == runs[0]["metrics"]
    assert cli("compare", written(), "--out", out)[0] == 0
