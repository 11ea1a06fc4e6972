"""With the force that its own acceleration takes, a robot on its reference stays there, by any controller."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate


def largest_error(**tracking):
    """Largest tracking error of a robot that starts on a moving reference (m)."""
    overrides = {
        "formation": {"shape": "line", "robots": 1, "side": 1.0},
        "robots.start": {"centre": [0.0, 0.0]},
        "transport": {"goal": [3.0, -1.0], "duration": 3.0, "reference": {"kind": "minimum_jerk"}},
        "aggregation.duration": 0.0,
        "avoidance": {"obstacles": []},
        "tracking": tracking,
    }
    result = simulate(load_scenario("line", overrides=overrides), engine="compiled")
    return np.abs(result["tracking_error"].values).max()


@pytest.mark.parametrize("kind", ["lqr", "lqi", "pid"])
def test_a_robot_on_its_reference_stays_there(kind):
    assert largest_error(kind=kind, feed_forward=True) < 1e-5
    assert largest_error(kind=kind) > 0.1


def test_sampled_it_strays_in_proportion_to_the_period():
    errors = [largest_error(kind="lqr_discrete", period=period, feed_forward=True) for period in (0.1, 0.05)]
    assert errors[0] < 0.1 < largest_error(kind="lqr_discrete", period=0.1)
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
