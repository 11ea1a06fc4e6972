"""The advice is that of its parts, in plain values, and says what has no answer."""

import json

import pytest
from unstable import UNSTABLE_BY_SPRINGS

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.compare import design
from drake_formation.analysis.gains.distributed_lqr import distributed_lqr
from drake_formation.analysis.gains.force_limited_gain import largest_gain
from drake_formation.analysis.gains.quadratic_cost import HandOffCost
from drake_formation.analysis.gains.tuning import tune, weight_of
from drake_formation.analysis.gains.velocity_gain import velocity_gain
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.response.worst_case_force import worst_case_force


@pytest.fixture(scope="module")
def formation():
    return linearize(load_scenario("quadrilateral", overrides={"consensus.delta": 1e4}))


def test_it_is_what_each_part_says(formation):
    advice = design(formation, damping_ratio=0.6, hand_off_error_m=0.02, travel_m=25.0, force_limit_n=300.0)
    assert advice.velocity == velocity_gain(formation, damping_ratio=0.6)
    assert (advice.present_error, advice.present_effort) == HandOffCost(formation, 0.02).error_and_effort(1e4, 0.0)
    tuned = tune(formation, effort_weight=weight_of(formation, 1e4), hand_off_error_m=0.02)
    assert advice.tuned.to_dict() == tuned.to_dict()
    assert advice.peak.force_n == worst_case_force(formation, hand_off_error_m=0.02, travel_m=25.0).force_n
    limited = largest_gain(formation, force_limit_n=300.0, hand_off_error_m=0.02, travel_m=25.0)
    assert advice.force_limited.to_dict() == limited.to_dict()
    assert advice.unanswered == {}


def test_three_ways_to_damp_a_stiffness_agree(formation):
    """Damping by 1/√2, the LQR and the least error for the effort are one for a mode of mass m and stiffness k."""
    advice = design(formation, damping_ratio=2**-0.5)
    gains = [advice.velocity.delta_v, advice.distributed.delta_v, advice.tuned.delta_v]
    assert gains == pytest.approx([gains[0]] * 3, rel=1e-3)
    assert [advice.distributed.delta, advice.tuned.delta] == pytest.approx([1e4, 1e4], rel=1e-3)


def test_without_consensus_the_local_weights_are_taken():
    line = linearize(load_scenario("line"))
    advice = design(line)
    assert advice.distributed.delta == distributed_lqr(line).delta
    assert advice.velocity.delta_v == 0
    assert (advice.tuned.delta, advice.tuned.delta_v) == (0.0, 0.0)
    assert advice.force_limited is None


def test_it_is_plain_json(formation):
    plain = json.loads(json.dumps(design(formation, force_limit_n=100.0).to_dict()))
    assert plain["velocity"]["damping_ratio"] == pytest.approx(0.7)
    assert plain["force_limited"]["force_limit_n"] == 100
    assert plain["unanswered"] == {}


def test_what_has_no_answer_is_said_and_the_rest_answered():
    unequal = linearize(load_scenario("line", overrides={"robots.mass": [20.0, 40.0], "consensus.delta": 100.0}))
    advice = design(unequal, force_limit_n=0.1, travel_m=10.0)
    assert set(advice.unanswered) == {"distributed", "force_limited"}
    assert "identical robots" in advice.unanswered["distributed"]
    assert advice.distributed is None
    assert advice.velocity.damping_ratio == pytest.approx(0.7)
    assert advice.to_dict()["distributed"] is None


def test_robots_that_do_not_all_talk_have_a_peak_only():
    apart = linearize(load_scenario("quadrilateral", overrides={"consensus.graph": [[1, 2], [3, 4]]}))
    advice = design(apart)
    assert set(advice.unanswered) == {"velocity", "distributed", "tuned"}
    assert advice.peak is not None
    assert advice.present_error is not None


def test_an_unstable_loop_has_no_advice_but_reasons():
    advice = design(linearize(load_scenario("line", overrides=UNSTABLE_BY_SPRINGS)))
    assert {"velocity", "tuned", "peak", "present"} <= set(advice.unanswered)
    assert all("unstable" in advice.unanswered[name] for name in ("velocity", "tuned", "peak", "present"))
    assert advice.distributed is not None
    assert not advice.distributed.stable


def test_a_distance_that_is_none_is_refused(formation):
    with pytest.raises(IllPosedError, match="distances"):
        design(formation, travel_m=-1.0)
