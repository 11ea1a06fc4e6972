"""Tables as text, and the sentence that says how much is prediction."""

from same_figures import SameFigures

from drake_formation.paper.readings.agreement import MARK, prediction_sentence, shown, table_section
from drake_formation.paper.readings.two_readings import READINGS
from drake_formation.paper.tables import Cell


def cell(**changes):
    given = {"published": 10.0, "ours": dict.fromkeys(READINGS, 12.5), "set_by": {"printed": "η", "simulated": ""}}
    given |= {"reasons": {"printed": "of this"}} | changes
    return Cell(table="T", row="r", column="c", unit="cm", **given)


def test_a_cell_shows_its_mark_its_difference_and_its_reason():
    assert shown(cell(), "printed", ["of that", "of this"]) == f"12.5{MARK} (+25 %, differs: 2)"
    assert shown(cell(), "simulated", []) == "12.5 (+25 %)"


def test_reasons_are_numbered_once():
    text = table_section("title", [cell(), cell(), cell(reasons={"simulated": "of that"})]).text
    assert text.count("1. of this.") == 1
    assert "2. of that." in text


def test_the_sentence_counts_predictions_apart():
    text = prediction_sentence(SameFigures())
    assert "of 54 cells agree" in text
    assert "of 34" in text
    assert "of 31" in text
