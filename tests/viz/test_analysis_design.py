"""The front of error against effort shows what the tuning found."""

import numpy as np
import pytest

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.quadratic_cost import HandOffCost
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.viz.analysis_design import pareto_front


@pytest.fixture(scope="module")
def formation():
    return linearize(load_scenario("line", overrides={"consensus.delta": 1e4}))


@pytest.fixture(scope="module")
def lines(formation):
    axes = pareto_front(formation)
    assert "(N² s)" in axes.get_xlabel()
    assert "(m² s)" in axes.get_ylabel()
    assert {axes.get_xscale(), axes.get_yscale()} == {"log"}
    words = {"alone": "alone", "front": "tuned", "scenario": "scenario"}
    return {
        name: next(line.get_xydata() for line in axes.lines if word in line.get_label()) for name, word in words.items()
    }


def test_the_front_falls_and_lies_under_everything_else(lines):
    effort, error = lines["front"].T
    assert np.all(np.diff(effort) > 0)
    assert np.all(np.diff(error) < 0)
    alone_effort, alone_error = np.concatenate([lines["alone"], lines["scenario"]]).T
    within = (alone_effort >= effort[0]) & (alone_effort <= effort[-1])
    assert within.any()
    best = np.exp(np.interp(np.log(alone_effort[within]), np.log(effort), np.log(error)))
    assert np.all(best <= alone_error[within] * 1.01)


def test_the_scenario_is_where_its_gains_put_it(formation, lines):
    error, effort = HandOffCost(formation).error_and_effort(1e4, 0.0)
    np.testing.assert_allclose(lines["scenario"], [[effort, error]])


def test_one_robot_has_no_front():
    alone = {"formation": {"shape": "slots", "slots": [[0, 0]]}, "robots.start": {"centre": [2.5, 3.5]}}
    with pytest.raises(IllPosedError, match="one robot"):
        pareto_front(linearize(load_scenario("line", overrides=alone)))
