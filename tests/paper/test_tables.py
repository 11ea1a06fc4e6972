"""Cells of the tables: what the paper prints beside what runs give."""

import pytest
from same_figures import SameFigures

from drake_formation.measuring import Metrics
from drake_formation.paper.published import published
from drake_formation.paper.quantities import TABLES, largest_robot
from drake_formation.paper.readings.two_readings import READINGS
from drake_formation.paper.runs import CASES, GAINS, MATERIALS
from drake_formation.paper.tables import all_entries, table, table_runs, transports


def test_table_1_is_what_the_runs_use():
    for cell in table("table1", None):
        assert cell.published == MATERIALS[cell.column]
        assert set(cell.ours.values()) == {cell.published}


@pytest.mark.parametrize("name", TABLES)
def test_every_published_number_has_a_cell(name):
    cells = table(name, SameFigures())
    robots = 2 if name == "table2" else 1
    assert len(cells) == len(GAINS) * len(MATERIALS) * robots * len(TABLES[name])
    for cell in cells:
        assert set(cell.ours) == set(READINGS)
        assert set(cell.ours.values()) == ({100.0} if cell.unit == "cm" else {1.0})
        assert {key for key in READINGS if not cell.agrees(key)} == set(cell.reasons)
        assert all(cell.reasons.values())
        assert cell.rerun.startswith("drake-formation reproduce --cell table")


def test_there_are_54_numbers():
    entries = all_entries(SameFigures(), READINGS["printed"].transport)
    assert len(entries) == 54
    assert sum(entry.robot > 0 for entry in entries) == 12


def test_a_table_may_be_read_otherwise():
    class Other(SameFigures):
        def measured(self, scenario):
            return Metrics(**{**super().measured(scenario), "tracking_error_m": [3.0, 2.0]})

    entries = all_entries(Other(), READINGS["printed"].transport, {"Table 4": largest_robot})
    assert {entry.ours for entry in entries if entry.quantity.table == "Table 4"} == {300.0}


def test_a_table_needs_a_run_by_each_reading_for_each_material_and_gain():
    assert len(table_runs("table3")) == len(READINGS) * len(GAINS) * len(MATERIALS)
    assert table_runs("table1") == []
    assert len(transports(READINGS["printed"].transport)) == len(CASES)


def test_published_numbers_are_those_of_the_shared_file():
    from pathlib import Path

    from ruamel.yaml import YAML

    shared = Path(__file__).parents[3] / "shared" / "published.yaml"
    if not shared.exists():
        pytest.skip("the shared folder is not here")
    assert published() == YAML(typ="safe").load(shared.read_text(encoding="utf-8"))
