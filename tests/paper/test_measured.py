"""What is measured of a run beside its metrics."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import load_scenario, simulate
from drake_formation.paper.measured import measured, rotation

SQUARE = np.array([[-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5], [0.5, 0.5]])
NUMBERS = st.floats(-1.0, 1.0)


@given(angle=NUMBERS, size=NUMBERS, shift=st.tuples(NUMBERS, NUMBERS))
def test_rotation_is_what_turns_and_neither_grows_nor_moves(angle, size, shift):
    turning = angle * np.column_stack([-SQUARE[:, 1], SQUARE[:, 0]])
    np.testing.assert_allclose(rotation(turning + size * SQUARE + np.array(shift), SQUARE), turning, atol=1e-12)


def test_without_obstacles_all_of_the_error_is_left_by_the_hand_off():
    scenario = load_scenario(
        "line", overrides={"avoidance.obstacles": [], "aggregation.duration": 1.0, "transport.duration": 2.0}
    )
    its = measured(scenario, simulate(scenario))
    assert its.disagreement_m == its.deformation_m == its.stacked_tracking_error_m == 0.0
    assert its.residual_m == pytest.approx(its.consensus_error_m, rel=1e-3)


def test_all_robots_together_are_off_by_more_than_one_and_less_than_their_sum():
    scenario = load_scenario("line", overrides={"aggregation.duration": 1.0, "transport.duration": 8.0})
    its = measured(scenario, simulate(scenario))
    assert 0 < max(its.tracking_error_m) <= its.stacked_tracking_error_m * (1 + 1e-3)
    assert its.stacked_tracking_error_m <= sum(its.tracking_error_m)
