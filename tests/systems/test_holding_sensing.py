import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import ScenarioError, load_scenario, simulate
from drake_formation.systems.holding_sensing import HoldingSensing, next_holders
from drake_formation.systems.sensing import nearest

distances = st.lists(st.floats(0.1, 10), min_size=2, max_size=5)
margins = st.floats(0, 2)


@given(distances)
def test_what_nobody_holds_the_nearest_takes(apart):
    assert next_holders(apart, [0.0] * len(apart), 0.5) == [nearest(apart, i) for i in range(len(apart))]


@given(distances, margins, st.data())
def test_it_is_handed_over_only_to_one_that_is_nearer_by_the_margin(apart, margin, data):
    holder = data.draw(st.integers(0, len(apart) - 1))
    holding = [float(i == holder) for i in range(len(apart))]
    found = next_holders(apart, holding, margin)
    if apart[holder] - min(apart) > margin:
        assert found == [nearest(apart, i) for i in range(len(apart))]
    else:
        assert found == holding


def test_the_block_carries_out_the_law_for_every_obstacle():
    block = HoldingSensing(2, [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]], [0.5])
    context = block.CreateDefaultContext()

    def seen(first, second):
        for port, x in (("state_1", first), ("state_2", second)):
            block.GetInputPort(port).FixValue(context, [x, 0.0, 0.0, 0.0])
        context.SetDiscreteState(block.EvalUniquePeriodicDiscreteUpdate(context))
        return [block.GetOutputPort(f"sensed_{i}").Eval(context).tolist() for i in (1, 2)]

    assert seen(1.0, 3.0) == [[1.0, 0.0], [0.0, 1.0]]
    assert seen(2.1, 1.9) == [[1.0, 0.0], [0.0, 1.0]]
    assert seen(2.4, 1.6) == [[0.0, 1.0], [1.0, 0.0]]


TIE = {
    "aggregation.duration": 0.0,
    "robots.start": {"centre": [8.0, 3.5]},
    "transport": {"goal": [25.0, 3.5], "duration": 6.0},
    "consensus": {"delta": 1e4, "delta_v": 300.0},
    "avoidance": {"sensing": "nearest", "obstacles": [{"position": [10.0, 3.5]}]},
}


def tie(**changes):
    return load_scenario("quadrilateral", overrides={**TIE, **changes})


def hand_overs(result):
    felt = np.linalg.norm(result["avoidance_force"].values, axis=-1) > 0
    return int((felt[1:] != felt[:-1]).any(axis=1).sum())


@pytest.mark.slow
def test_robots_that_are_equally_near_no_longer_see_it_in_turns():
    at_once = simulate(tie(), engine="compiled")
    holding = simulate(tie(**{"avoidance.margin": 0.1}), engine="compiled")
    assert hand_overs(at_once) > 100
    assert at_once.attrs["remark"]
    assert hand_overs(holding) < 20
    assert "remark" not in holding.attrs


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    obstacles = [{"position": [9.0, 5.0]}, {"position": [10.5, 2.0]}]
    changes = {"avoidance.margin": 0.2, "avoidance.obstacles": obstacles, "transport.duration": 2.0}
    scenario = tie(**changes, **{"consensus.delta": 10.0})
    found, blocks = (simulate(scenario, engine=name)["position"].values[-1] for name in (engine, "blocks"))
    np.testing.assert_allclose(found, blocks, rtol=0, atol=1e-4)


def test_robots_with_different_margins_are_refused():
    with pytest.raises(ScenarioError, match=r"avoidance.margin.1: robots that compare .* different margins"):
        tie(**{"avoidance.margin": {"1": 0.1, "default": 0.2}})
