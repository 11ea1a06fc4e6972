"""The README's table of the paper is what the study gives."""

import re
from pathlib import Path

import pytest

from drake_formation.paper.readings.agreement import MARK, number
from drake_formation.paper.readings.two_readings import READINGS
from drake_formation.paper.rerun import Fresh
from drake_formation.paper.tables import table

README = Path(__file__).parents[2] / "README.md"


@pytest.mark.slow
def test_the_table_of_four_robots_is_that_of_the_report():
    (text,) = re.findall(r"<!-- table5 -->\n(.*?)<!-- /table5 -->", README.read_text(encoding="utf-8"), re.DOTALL)
    rows = [line.strip("| ").split(" | ")[1:] for line in text.splitlines()[2:]]
    cells = table("table5", Fresh())
    assert len(rows) * len(rows[0]) == len(cells)
    for k, cell in enumerate(cells):  # by quantity, then material, then gain; in the README gains are the rows
        ours = [f"{number(cell.ours[key])}{MARK if cell.set_by[key] else ''}" for key in READINGS]
        assert rows[k % 3][k // 3] == " / ".join([f"{cell.published:g}", *ours])
