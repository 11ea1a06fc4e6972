"""Tuned gains: the LQR where there is one, the best of a grid everywhere, and a front that falls."""

import json

import numpy as np
import pytest

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.distributed_lqr import distributed_lqr
from drake_formation.analysis.gains.quadratic_cost import HandOffCost
from drake_formation.analysis.gains.tuning import pareto, tune, weight_of
from drake_formation.analysis.linear.errors import IllPosedError

UNEQUAL = {
    "robots.mass": [10.0, 20.0, 40.0, 80.0],
    "consensus.graph": "path",
    "springs.stiffness": 500.0,
    "springs.damping": 3.0,
}


@pytest.mark.parametrize(("name", "robots"), [("line", 2), ("quadrilateral", 4), ("octagon", 8)])
@pytest.mark.parametrize("wanted", [10.0, 4e4])
def test_without_an_object_it_is_the_lqr_of_a_relative_mode(name, robots, wanted):
    formation = linearize(load_scenario(name, overrides={"springs.stiffness": 0.0}))
    found = tune(formation, effort_weight=wanted**-2)
    assert 1 + robots * found.delta == pytest.approx(wanted, rel=1e-4)
    assert 9 + robots * found.delta_v == pytest.approx(np.sqrt(80 * wanted), rel=1e-4)
    assert found.at_bound == ()


def test_it_is_the_distributed_lqr_of_the_same_weights():
    """Relative positions weighted by Q₂ against forces by R, with nothing but the local damping's cost between."""
    changes = {"springs.stiffness": 0.0, "tracking.Q": [1.0, 1.0, 0.0, 0.0]}
    formation = linearize(load_scenario("quadrilateral", overrides=changes))
    lqr = distributed_lqr(formation, relative_cost=[100.0, 100.0, 0.0, 0.0])
    found = tune(formation, effort_weight=1 / (1 + 4 * 100.0))
    assert (found.delta, found.delta_v) == pytest.approx((lqr.delta, lqr.delta_v), rel=1e-4)


@pytest.mark.parametrize(
    "changes",
    [UNEQUAL, {"consensus.graph": "star"}, {"springs.stiffness": 3e4}],
    ids=["unequal", "star", "steel"],
)
@pytest.mark.parametrize("weight", [1e-9, 1e-4, 1.0])
def test_nothing_on_a_grid_is_better(changes, weight):
    formation = linearize(load_scenario("quadrilateral", overrides=changes))
    found = tune(formation, effort_weight=weight)
    costs = HandOffCost(formation)
    grid = np.concatenate([[0.0], np.geomspace(1e-3, 1e3, 41)])
    best = min(costs.cost(found_at * np.array([found.delta, found.delta_v]), weight)[0] for found_at in pairs(grid))
    assert found.cost <= best * (1 + 1e-9)
    assert found.cost == pytest.approx(costs.cost(np.array([found.delta, found.delta_v]), weight)[0])


def pairs(values):
    return (np.array([a, b]) for a in values for b in values)


def test_bounds_are_kept_and_said():
    formation = linearize(load_scenario("quadrilateral"))
    free = tune(formation, effort_weight=1e-8)
    bounded = tune(formation, effort_weight=1e-8, largest_delta_v=free.delta_v / 2)
    assert bounded.delta_v == pytest.approx(free.delta_v / 2)
    assert bounded.at_bound == ("delta_v",)
    assert bounded.cost > free.cost
    nothing = tune(formation, effort_weight=1e3)
    assert (nothing.delta, nothing.delta_v) == (0.0, 0.0)
    assert nothing.at_bound == ("delta", "delta_v")


@pytest.mark.parametrize("changes", [{}, UNEQUAL], ids=["published", "unequal"])
def test_along_the_front_error_falls_as_effort_rises(changes):
    formation = linearize(load_scenario("quadrilateral", overrides=changes))
    front = pareto(formation, np.geomspace(1e-10, 1e-1, 10))
    assert np.all(np.diff([tuned.error for tuned in front]) > 0)
    assert np.all(np.diff([tuned.effort for tuned in front]) < 0)


def test_published_gains_are_far_from_the_front():
    """A virtual spring without damping swings for long: δ alone buys hardly any error, at any effort."""
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.delta": 1e4}))
    tuned = tune(formation, effort_weight=weight_of(formation, 1e4))
    error, effort = HandOffCost(formation).error_and_effort(1e4, 0.0)
    assert tuned.delta == pytest.approx(1e4, rel=1e-3)
    assert error > 50 * tuned.error
    assert effort > 100 * tuned.effort
    assert HandOffCost(formation).error_and_effort(2e4, 0.0)[0] > 0.99 * error


def test_it_is_plain_json():
    found = tune(linearize(load_scenario("line")), effort_weight=1e-6)
    assert json.loads(json.dumps(found.to_dict()))["effort_weight_m2_per_n2"] == 1e-6


@pytest.mark.parametrize(
    ("changes", "question", "words"),
    [
        ({"formation": {"shape": "slots", "slots": [[0, 0]]}, "robots.start": {"centre": [0, 0]}}, {}, "one robot"),
        ({}, {"effort_weight": 0.0}, "effort_weight"),
        ({}, {"largest_delta": -1.0}, "largest_delta"),
        ({}, {"hand_off_error_m": np.inf}, "hand_off_error_m"),
    ],
)
def test_questions_without_an_answer_say_so(changes, question, words):
    with pytest.raises(IllPosedError, match=words):
        tune(linearize(load_scenario("line", overrides=changes)), **{"effort_weight": 1e-4, **question})
