"""Cells of the tables: what the paper prints beside what a run gives."""

import pytest

from drake_formation.paper import tables
from drake_formation.paper.published import PROVENANCE, published
from drake_formation.paper.runs import GAINS, MATERIALS
from drake_formation.paper.tables import TABLES, Cell, table, table_runs


def cell(ours, printed=10.0):
    return Cell(table="T", row="r", column="c", unit="cm", published=printed, ours=ours)


@pytest.mark.parametrize(("ours", "agrees"), [(10.0, True), (11.9, True), (8.1, True), (12.1, False), (7.9, False)])
def test_a_cell_agrees_within_a_fifth(ours, agrees):
    assert cell(ours).agrees is agrees
    assert cell(ours).difference == pytest.approx(ours - 10.0)


def test_table_1_is_what_the_runs_use():
    assert {c.column: c.published for c in table("table1", None)} == MATERIALS


@pytest.mark.parametrize("name", TABLES)
def test_every_published_number_has_a_cell(name, monkeypatch):
    """Run nothing: let every run give the same metrics, and count."""
    metrics = tables.Metrics(
        tracking_error_m=[1.0, 1.0] if name == "table2" else [1.0],
        consensus_error_m=1.0,
        peak_force_n=1.0,
        min_clearance_m=None,
        max_spring_strain=None,
        settling_time_s=None,
    )
    monkeypatch.setattr(tables, "metrics", lambda _result: metrics)

    class NoRuns:
        def __getitem__(self, scenario):
            return scenario

    cells = table(name, NoRuns())
    per_quantity = len(GAINS) * len(MATERIALS) * len(metrics.tracking_error_m)
    assert len(cells) == per_quantity * len(TABLES[name])
    assert all(c.agrees or c.reason for c in cells)
    assert all(c.ours == 100.0 if c.unit == "cm" else c.ours == 1.0 for c in cells)


def test_a_table_needs_a_run_for_each_material_and_gain():
    assert len(table_runs("table3")) == len(GAINS) * len(MATERIALS)
    assert table_runs("table1") == []


def test_every_parameter_has_a_provenance():
    assert all(source.split(":")[0].split()[0] in {"published", "inferred", "chosen"} or "published" in source
               for *_, source in PROVENANCE)  # fmt: skip


def test_published_numbers_are_those_of_the_shared_file():
    from pathlib import Path

    from ruamel.yaml import YAML

    shared = Path(__file__).parents[3] / "shared" / "published.yaml"
    if not shared.exists():
        pytest.skip("the shared folder is not here")
    assert published() == YAML(typ="safe").load(shared.read_text(encoding="utf-8"))
