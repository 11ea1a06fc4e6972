"""A pure delay between robots."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import build_diagram, load_scenario, simulate, with_overrides
from drake_formation.parts.channels.delay_line import between

LINE = {
    "aggregation.duration": 0.0,
    "transport.duration": 3.0,
    "springs.stiffness": 1.45,
    "consensus.delta": 40.0,
    "consensus.delta_v": 20.0,
    "robots.start": [[0.0, -0.6], [0.3, 0.7]],
    "transport.goal": [3.0, 0.0],
}
numbers = st.floats(-5, 5)


def line(delay, **more):
    channel = {"kind": "delay", "delay": delay} | more
    return load_scenario("line", overrides=LINE | {"consensus.channel": channel})


@given(st.lists(numbers, min_size=4, max_size=4), st.floats(0, 1), st.floats(0.01, 2))
def test_a_cubic_is_read_exactly(coefficients, share, span):
    place, speed = np.polynomial.Polynomial(coefficients), np.polynomial.Polynomial(coefficients).deriv()
    read = between(share, span, (place(0.0), speed(0.0)), (place(span), speed(span)))
    assert read == pytest.approx((place(share * span), speed(share * span)), abs=1e-9)


def test_without_delay_it_is_the_wire_itself():
    plain = load_scenario("line", overrides=LINE)
    for engine in ("blocks", "compiled"):
        runs = [simulate(scenario, engine=engine)["position"] for scenario in (line(0.0), plain)]
        np.testing.assert_array_equal(*runs)


@pytest.mark.slow
def test_engines_agree_and_finer_pieces_change_little():
    runs = [simulate(line(0.2), engine=engine) for engine in ("blocks", "compiled")]
    ends = [run["position"].values[-1] for run in runs]
    np.testing.assert_allclose(*ends, atol=1e-5)
    finer = simulate(line(0.2, pieces=64), engine="compiled")["position"].values[-1]
    np.testing.assert_allclose(ends[1], finer, atol=1e-5)


def test_what_is_heard_is_what_was_sent_a_delay_ago():
    """A chain of integrations, step by step: Drake's trajectory of the run, read a delay earlier, gives the force."""
    run = simulate(line(0.25), engine="compiled")
    time, position, velocity = (run[name].values for name in ("time", "position", "velocity"))
    slots = run["slot"].values
    late = time > 0.3
    place, speed = (
        np.stack([np.interp(time - 0.25, time, series[:, 1, k]) for k in (0, 1)], -1) for series in (position, velocity)
    )
    apart = position[:, 0] - place - (slots[0] - slots[1])
    expected = -(40.0 * apart + 20.0 * (velocity[:, 0] - speed))
    np.testing.assert_allclose(run["consensus_force"].values[late, 0], expected[late], atol=0.02)


def test_the_beginning_need_not_be_at_zero():
    scenarios = line(0.2), with_overrides(line(0.2), {"simulator.start_time": 0.37})
    ends = [simulate(scenario, engine="compiled")["position"].values[-1] for scenario in scenarios]
    np.testing.assert_allclose(*ends, atol=1e-7)


def test_it_stands_in_the_diagram():
    diagram = build_diagram(line(0.1))
    assert "channel_2_to_1" in diagram.GetGraphvizString()
    diagram.ToAutoDiffXd()
    diagram.ToSymbolic()
