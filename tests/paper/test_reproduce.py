"""Parts of the study, written as a report."""

import csv

import pytest

from drake_formation.paper.report import to_html
from drake_formation.paper.reproduce import reproduce
from drake_formation.paper.study import PARTS

WITHOUT_RUNS = ["parameters", "table1", "fig1", "fig2", "fig3", "fig20", "fig22"]


def test_the_study_covers_the_paper():
    figures = [*range(1, 24)]
    assert [f"fig{n}" for n in figures] == [name for name in PARTS if name.startswith("fig")]
    assert [f"table{n}" for n in range(1, 7)] == [name for name in PARTS if name.startswith("table")]


def test_parts_are_written_as_markdown_html_and_csv(tmp_path):
    counts = []
    reproduce(tmp_path, WITHOUT_RUNS, lambda done, total: counts.append((done, total)))
    assert counts == [(0, 0)]
    markdown = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "30000" in markdown
    pictures = sorted(path.stem for path in (tmp_path / "figures").iterdir())
    assert pictures == sorted(name for name in WITHOUT_RUNS if name.startswith("fig"))
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert page.count('src="data:image/png;base64,') == len(pictures)
    assert "<table>" in page
    rows = list(csv.DictReader((tmp_path / "tables.csv").open(encoding="utf-8")))
    for column in ("published", "printed", "simulated"):
        assert {row["column"]: float(row[column]) for row in rows} == {"rubber": 1.45, "steel": 30000.0}


def test_the_same_command_twice_gives_the_same_report(tmp_path):
    for folder in ("a", "b"):
        reproduce(tmp_path / folder, WITHOUT_RUNS)
    for name in ("report.html", "tables.csv"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_an_unknown_part_is_refused_with_the_nearest(tmp_path):
    with pytest.raises(ValueError, match="did you mean 'table3'"):
        reproduce(tmp_path, ["tabel3"])


def test_html_holds_its_pictures(tmp_path):
    (tmp_path / "a.png").write_bytes(b"picture")
    assert "data:image/png;base64,cGljdHVyZQ==" in to_html("![a](a.png)", tmp_path)
