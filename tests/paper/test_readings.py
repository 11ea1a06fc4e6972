"""Two readings of who feels an obstacle differ in that alone."""

from drake_formation import with_overrides
from drake_formation.paper.readings import READINGS, agreement, nearest_only
from drake_formation.paper.runs import transport
from drake_formation.paper.tables import Cell


def test_the_readings_differ_in_the_sensing_alone():
    used, other = (run("line", "rubber", 0.0) for run in READINGS.values())
    assert used == transport("line", "rubber", 0.0)
    assert other == nearest_only("line", "rubber", 0.0)
    assert with_overrides(other, {"avoidance.sensing": "in_range"}) == used


def test_agreement_counts_cells():
    cells = [Cell(table="T", row="", column="", unit="", published=1.0, ours=ours) for ours in (1.0, 1.1, 2.0)]
    assert agreement(cells) == "2 of 3"
