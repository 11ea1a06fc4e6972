"""Hands hold while grips do, and crosses are over robots that are out of order."""

import numpy as np
import pytest
from carrying import carried

from drake_formation import simulate
from drake_formation.viz.playback import Playback
from drake_formation.viz.view import page
from drake_formation.viz.view.marks import pinned

DROPS = "[{robot: 1, time: 1.2, kind: drops_load, repaired_at: 1.4}, {robot: 2, time: 1.3, kind: stops_actuating}]"


@pytest.fixture(scope="module")
def result():
    return simulate(carried("{kind: rigid}", failures=DROPS), engine="blocks")


def test_a_robot_that_dropped_its_load_holds_nothing_until_it_is_repaired(result):
    playback = Playback(result)
    times = np.array([0.1, 1.1, 1.25, 1.5])
    assert playback.carried(times).tolist() == [False, True, True, True]
    assert playback.gripped(times)[:, :2].tolist() == [[False, False], [True, True], [False, True], [True, True]]
    assert playback.failed(times)[:, :2].tolist() == [[False, False], [False, False], [True, False], [False, True]]


def test_the_page_tells_what_its_marks_are(result):
    text = page(result)
    assert "hands</b> that hold the object" in text
    assert "cross</b> over robots out of order" in text
    assert [event.kind for event in pinned(Playback(result).events)] == ["failure", "failure", "repair"]
