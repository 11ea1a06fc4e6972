"""Robots that keep away from each other."""

import numpy as np
import pytest

from drake_formation import ScenarioError, load_scenario, metrics, simulate
from drake_formation.analysis import certify
from drake_formation.parts.avoidance.khatib import avoidance_force


def crossing(**avoidance):
    """Two robots that gather from behind each other's slot, nearly head-on."""
    overrides = {
        "formation": {"shape": "line", "robots": 2, "side": 2.0},
        "robots.start": [[0.02, 1.0], [-0.02, -1.0]],
        "tracking": {"Q": 100.0},
        "transport": {"goal": [5.0, 0.0], "duration": 1.0},
        "aggregation.duration": 8.0,
        "avoidance": {"obstacles": [], **avoidance},
    }
    return load_scenario("line", overrides=overrides)


def least_distance(result):
    position = result["position"].values
    return np.linalg.norm(position[:, 0] - position[:, 1], axis=1).min()


@pytest.mark.parametrize("kind", ["khatib", "rotational"])
def test_robots_that_would_meet_keep_apart(kind):
    assert least_distance(simulate(crossing(kind=kind), engine="compiled")) < 0.1
    assert least_distance(simulate(crossing(kind=kind, robots=True, gain=5.0), engine="compiled")) > 0.15


def test_the_force_is_the_fields_from_every_robot_heard_and_equal_and_opposite():
    result = simulate(crossing(robots=True, spacing=1.5), engine="blocks")
    position, force = result["position"].values, result["avoidance_force"].values
    apart = position[:, 0] - position[:, 1]
    expected = np.stack(avoidance_force(*apart.T, 0.0, 1.5, 31.56), axis=-1)
    np.testing.assert_allclose(force[:, 0], expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(force[:, 1], -expected, rtol=1e-9, atol=1e-9)
    assert np.abs(expected).max() > 10.0


@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    scenario = crossing(robots=True)
    found, blocks = (simulate(scenario, engine=name)["position"].values[-1] for name in (engine, "blocks"))
    np.testing.assert_allclose(found, blocks, rtol=0, atol=1e-3)


def test_in_formation_nothing_is_felt():
    overrides = {
        "aggregation.duration": 0.0,
        "transport.duration": 2.0,
        "robots.start": {"centre": [1.0, 2.0]},
        "avoidance": {"robots": True, "obstacles": []},
    }
    result = simulate(load_scenario("line", overrides=overrides), engine="blocks")
    assert not result["avoidance_force"].values.any()


def test_a_spacing_beyond_the_formations_own_is_refused():
    with pytest.raises(ScenarioError, match=r"avoidance.spacing: robots 1 and 2 would be pushed out .*below 2 m"):
        crossing(robots=True, spacing=2.0)


def test_it_is_analysed_where_it_is_not_felt_and_measured():
    scenario = crossing(robots=True)
    assert certify(scenario).stable == certify(crossing()).stable
    assert metrics(simulate(scenario, engine="compiled")).peak_force_n > 0
