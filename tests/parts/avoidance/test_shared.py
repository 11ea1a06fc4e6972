"""Obstacles that robots tell each other of."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import load_scenario, simulate
from drake_formation.parts.avoidance.khatib import avoidance_force
from drake_formation.parts.avoidance.shared import NEAREST, SharedAvoidance, told_force

OBSTACLES = [{"position": [3.2, 4.9]}, {"kind": "segment", "ends": [[3.0, 2.2], [5.0, 2.0]], "radius": 0.1}]
MOVING = {"position": [5.0, 4.0], "radius": 0.2, "velocity": [-0.2, 0.0], "start": 1.0}


def passing(channel=None, obstacles=OBSTACLES, duration=6.0, **avoidance):
    """Four robots on their way between obstacles, each of which only some of them sense."""
    overrides = {
        "aggregation.duration": 0.0,
        "robots.start": {"centre": [1.6875, 3.5125]},
        "consensus": {"graph": "complete", "delta": 100.0, "delta_v": 60.0, "channel": channel or {"kind": "ideal"}},
        "avoidance": {"kind": "shared", "obstacles": obstacles, "gain": 5.0, **avoidance},
        "transport": {"goal": [12.0, 3.5125], "duration": duration},
    }
    return load_scenario("quadrilateral", overrides=overrides)


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(0, 0.5), st.floats(0, 0.3))
def test_what_is_told_is_khatibs_force_but_finite(dx, dy, radius, footprint):
    clearance, told = np.hypot(dx, dy) - radius - footprint, told_force(dx, dy, radius, footprint, 1.3, 5.0)
    if clearance >= NEAREST * 1.3:
        assert told == pytest.approx(avoidance_force(dx, dy, radius + footprint, 1.3, 5.0), rel=1e-9)
    nearest = NEAREST * 1.3
    assert np.hypot(*told) <= 5.0 * (1 / nearest - 1 / 1.3) / nearest**2 * (1 + 1e-9)


def test_over_ideal_complete_channels_all_yield_to_the_same_force_and_keep_their_shape():
    result = simulate(passing(), engine="compiled")
    force, position = result["avoidance_force"].values, result["position"].values
    assert np.linalg.norm(force, axis=-1).max() > 2.0
    np.testing.assert_allclose(force, np.broadcast_to(force[:, :1], force.shape), rtol=1e-9, atol=1e-9)
    sides = position - position.mean(axis=1, keepdims=True)
    np.testing.assert_allclose(sides, np.broadcast_to(sides[0], sides.shape), atol=1e-6)


def test_where_only_who_senses_reacts_the_shape_is_lost():
    result = simulate(passing(kind="khatib"), engine="compiled")
    assert result["consensus_error"].values.max() > 0.005


def test_without_a_share_it_is_khatib():
    alone, khatib = (simulate(passing(**law), engine="compiled") for law in ({"share": 0.0}, {"kind": "khatib"}))
    np.testing.assert_allclose(alone["position"].values[-1], khatib["position"].values[-1], atol=1e-5)


def test_a_share_of_the_force_at_every_state_heard_is_added():
    radii, own, heard = [0.0, 0.0, 0.0], [2.6, 4.5], [[2.4, 4.4], [50.0, 50.0]]
    block = SharedAvoidance([1.3, 5.0, 0.5], [3.2, 4.9, 0.0], radii, (2, 4), ((1, 0),))
    context = block.CreateDefaultContext()
    block.GetInputPort("phase").FixValue(context, [1.0])
    for name, place in zip(("state", "channel_2", "channel_4"), (own, *heard), strict=True):
        block.GetInputPort(name).FixValue(context, [*place, 0.0, 0.0])
    forces = [np.array(avoidance_force(x - 3.2, y - 4.9, 0.0, 1.3, 5.0)) for x, y in (own, heard[0])]
    assert block.GetOutputPort("force").Eval(context) == pytest.approx(forces[0] + 0.5 * forces[1])


@pytest.mark.slow
@pytest.mark.parametrize("channel", [None, {"kind": "packets", "period": 0.05, "delay": 0.02, "loss": 0.1}])
def test_compiled_agrees_with_blocks_also_where_obstacles_move(channel):
    scenario = passing(channel, [*OBSTACLES, MOVING], duration=3.0)
    compiled, blocks = (simulate(scenario, engine=engine)["position"].values[-1] for engine in ("compiled", "blocks"))
    np.testing.assert_allclose(compiled, blocks, rtol=0, atol=1e-4)
