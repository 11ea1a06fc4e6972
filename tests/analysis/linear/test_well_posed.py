"""Robots that cannot agree have no consensus gains to choose, whatever the way of choosing."""

import pytest

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.distributed_lqr import distributed_lqr
from drake_formation.analysis.gains.force_limited_gain import largest_gain
from drake_formation.analysis.gains.quadratic_cost import HandOffCost
from drake_formation.analysis.gains.start_limited_gain import start_limited_gain
from drake_formation.analysis.gains.tuning import tune
from drake_formation.analysis.gains.velocity_gain import velocity_gain
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.well_posed import require_agreement
from drake_formation.analysis.response.worst_case_force import worst_case_force

WAYS = {
    "velocity_gain": lambda formation: velocity_gain(formation, damping_ratio=0.7),
    "distributed_lqr": distributed_lqr,
    "tune": lambda formation: tune(formation, effort_weight=1e-4),
    "largest_gain": lambda formation: largest_gain(formation, force_limit_n=100.0, hand_off_error_m=0.01),
    "start_limited_gain": lambda formation: start_limited_gain(formation.scenario, force_limit_n=100.0),
}
ALONE = {"formation": {"shape": "slots", "slots": [[0, 0]]}, "robots.start": {"centre": [2.5, 3.5]}}


@pytest.fixture(scope="module")
def pairs():
    """Two pairs of robots that do not talk to each other."""
    return linearize(load_scenario("quadrilateral", overrides={"consensus.graph": [[1, 2], [3, 4]]}))


@pytest.mark.parametrize("way", WAYS)
def test_separate_robots_are_told_so(way, pairs):
    with pytest.raises(IllPosedError, match="2 parts"):
        WAYS[way](pairs)


@pytest.mark.parametrize("way", WAYS)
def test_one_robot_is_told_so(way):
    with pytest.raises(IllPosedError, match="one robot"):
        WAYS[way](linearize(load_scenario("line", overrides=ALONE)))


@pytest.mark.parametrize("name", ["line", "quadrilateral", "octagon"])
def test_connected_robots_may_ask(name):
    require_agreement(linearize(load_scenario(name, overrides={"consensus.graph": "path"})), "gain")


def test_what_needs_no_agreement_is_answered(pairs):
    silent = linearize(load_scenario("quadrilateral", overrides={"consensus.graph": []}))
    for formation in (pairs, silent):
        worst = worst_case_force(formation, hand_off_error_m=0.04, travel_m=25.0)
        assert worst.force_n == pytest.approx(25.04, abs=0.1)
    apart, alone = (HandOffCost(formation).error_and_effort(0.0, 0.0) for formation in (pairs, silent))
    assert apart == pytest.approx(alone)
    assert HandOffCost(silent).error_and_effort(1e4, 10.0) == pytest.approx(alone)
