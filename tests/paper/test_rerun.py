"""One cell run again."""

import re

import pytest

from drake_formation.paper import runs
from drake_formation.paper.rerun import rerun
from drake_formation.scenario import load_scenario

SHORT = {"aggregation.duration": 1.0, "transport.duration": 4.0}


@pytest.mark.parametrize("name", ["table7:steel:1e4", "table5:wood:0", "table5:steel:3", "table5:steel", "", "a:b:c:d"])
def test_a_cell_that_is_not_there_is_refused_with_those_that_are(name):
    with pytest.raises(ValueError, match="rubber, steel; 0, 10000, 20000"):
        rerun(name)


def test_a_number_that_is_changed_in_a_scenario_changes_the_sentence(monkeypatch):
    """As printed: the force at the set point's distance is the cell's, and that of the sentence on why it differs."""
    said = []
    for x in (8.5, 12.5):
        given = SHORT | {"transport.goal": [x, 3.5]}
        monkeypatch.setattr(runs, "shipped", lambda name, given=given: load_scenario(name, overrides=given))
        text = rerun("table3:rubber:0")
        (cell,) = re.findall(r"‖u_i‖, δ = 0 \| rubber \| 22.5 \| ([\d.]+)°", text)
        (sentence,) = re.findall(r"push at the hand-off: ([\d.]+) N here, 22.5 N published", text)
        assert float(sentence) == pytest.approx(float(cell), abs=0.06)
        said.append(float(sentence))
    assert 3.0 < said[1] - said[0] < 5.0
