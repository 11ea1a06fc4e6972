"""How many cells agree."""

import pytest

from drake_formation.paper.readings.score import agrees, score


@pytest.mark.parametrize(("ours", "expected"), [(10.0, True), (11.9, True), (8.1, True), (12.1, False), (7.9, False)])
def test_a_cell_agrees_within_a_fifth(ours, expected):
    assert agrees(10.0, ours) is expected


def test_a_score_counts_cells():
    its = score([(1.0, 1.0), (1.0, 1.15), (2.0, 4.0)])
    assert (str(its), its.close, its.off) == ("2 of 3", 1, pytest.approx(0.15))
