"""Baselines without coordination, without local control, and without either."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.analysis.gains.tuning import tune

SHORT = {"aggregation.duration": 1.0, "transport.duration": 2.0}
NONE = {"kind": "none"}


def run(engine="blocks", **sections):
    return simulate(load_scenario("line", overrides={**SHORT, **sections}), engine=engine)


def test_without_coordination_robots_move_as_with_consensus_of_no_gain():
    alone, idle = run(consensus=NONE), run(consensus={"delta": 0.0})
    np.testing.assert_array_equal(alone["position"], idle["position"])
    assert not alone["consensus_force"].any()


def test_without_any_control_the_centre_of_mass_stays_and_the_tracking_error_is_recorded():
    result = run(consensus=NONE, tracking=NONE)
    assert not result["control_force"].any()
    assert np.ptp(result["position"].values.mean(axis=1), axis=0).max() < 1e-12
    assert np.ptp(result["position"].values, axis=0).max() > 0.01  # the object draws the robots together
    reference = load_scenario("line").transport.goal + np.array([[0, -0.5], [0, 0.5]])
    np.testing.assert_allclose(result["tracking_error"][-1], result["position"][-1].values - reference, atol=1e-12)


def test_a_robot_without_local_control_is_drawn_by_consensus_alone():
    tracking = {"kind": {1: "lqr", "default": "none"}}
    result = run(tracking=tracking, consensus={"delta": 10.0})
    assert not result["tracking_force"].sel(robot=2).any()
    assert result["tracking_force"].sel(robot=1).any()
    np.testing.assert_array_equal(result["control_force"].sel(robot=2), result["consensus_force"].sel(robot=2))


@pytest.mark.parametrize("sections", [{"consensus": NONE}, {"tracking": NONE}, {"consensus": NONE, "tracking": NONE}])
def test_engines_agree(sections):
    ends = [run(engine, **sections)["position"][-1] for engine in ("blocks", "compiled")]
    np.testing.assert_allclose(*ends, rtol=0, atol=1e-6)


def test_what_cannot_be_certified_is_refused_with_the_reason():
    with pytest.raises(IllPosedError, match="robot 1 coordinates by 'none'"):
        linearize(load_scenario("line", overrides={"consensus": NONE}))
    drifting = linearize(load_scenario("line", overrides={"tracking": NONE, "consensus.delta": 100.0}))
    assert np.linalg.eigvals(drifting.A).real.max() > -1e-6  # nothing brings the centre to its goal
    with pytest.raises(IllPosedError, match="no local stiffness"):
        tune(drifting, effort_weight=1e-4)
