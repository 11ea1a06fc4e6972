"""What metrics say of packets."""

import numpy as np
import pytest

from drake_formation import load_scenario, metrics, simulate
from drake_formation.measuring import measure
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.result import series_of

SQUARE = {
    "aggregation.duration": 2.0,
    "transport.duration": 4.0,
    "springs.stiffness": 1.45,
    "consensus.delta": 20.0,
    "consensus.delta_v": 20.0,
}


def run(engine="compiled", **channel):
    overrides = SQUARE | {"consensus.channel": {"kind": "packets"} | channel}
    return simulate(load_scenario("quadrilateral", overrides=overrides), engine=engine)


def test_without_packets_there_is_nothing_to_say():
    figures = metrics(simulate(load_scenario("quadrilateral", overrides=SQUARE), engine="compiled"))
    assert figures.messages_sent is None
    assert figures.peak_age_s is None


@pytest.mark.slow
def test_a_network_without_fault_delivers_all():
    figures = metrics(run(period=0.02, bits=100.0))
    assert figures.messages_sent == figures.messages_delivered == pytest.approx(12 * 4.0 / 0.02, abs=12)
    assert figures.messages_lost == figures.messages_late == figures.messages_overtaken == 0
    assert figures.bit_rate_bps == pytest.approx(12 * 100 / 0.02, rel=0.01)
    assert figures.mean_age_s == pytest.approx(0.01, rel=1e-6)
    assert figures.peak_age_s == pytest.approx(0.02, rel=1e-6)


def test_a_delay_adds_to_the_age():
    figures = metrics(run(period=0.02, delay=0.06))
    assert figures.mean_age_s == pytest.approx(0.06 + 0.01, rel=1e-3)
    assert figures.peak_age_s == pytest.approx(0.06 + 0.02, rel=1e-3)


@pytest.mark.parametrize("seed", [0, 1])
def test_what_is_sent_is_delivered_lost_or_under_way(seed):
    scenario = {"profile": "lossy"}
    overrides = SQUARE | {"consensus.channel": {"kind": "packets"} | scenario, "seed": seed}
    result = simulate(load_scenario("quadrilateral", overrides=overrides), engine="compiled")
    packets = Transport(series_of(result)).packets
    under_way = packets.sent - packets.lost - packets.delivered
    assert (np.abs(under_way) <= 5).all()  # 40 ms at 10 ms a packet, at the beginning and at the end
    assert packets.lost.sum() / packets.sent.sum() == pytest.approx(0.1, abs=0.03)
    assert list(result["channel"].values[:3]) == ["2-1", "3-1", "4-1"]


def test_both_engines_count_the_same():
    given = {"profile": "lossy", "distribution": "gamma"}
    blocks, compiled = (metrics(run(engine, **given)) for engine in ("blocks", "compiled"))
    for name in ("sent", "delivered", "lost", "late", "overtaken"):
        assert blocks[f"messages_{name}"] == compiled[f"messages_{name}"]
    assert blocks.mean_age_s == pytest.approx(compiled.mean_age_s, rel=1e-6)


def test_time_outside_tolerance_counts_every_crossing():
    result = simulate(load_scenario("line", overrides={"transport.duration": 20.0}), engine="compiled")
    error = np.linalg.norm(result["consensus_error"], axis=-1).max(axis=-1)
    carried = result["phase"].values == 1
    time, error = result["time"].values[carried], error[carried]
    fine = np.linspace(time[0], time[-1], 200_001)
    beyond = np.interp(fine, time, error) > 0.05
    expected = beyond.mean() * (time[-1] - time[0])
    assert measure(series_of(result)).outside_tolerance_s == pytest.approx(expected, abs=1e-3)
    assert beyond.any()


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "told"), [("none", []), ("leader_follower", ["1-2", "1-3", "1-4"])])
@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_channels_nobody_listens_to_carry_nothing(engine, kind, told):
    channel = {"kind": "packets", "period": 0.1}
    overrides = {
        "aggregation.duration": 0.0,
        "transport.duration": 1.0,
        "consensus": {"kind": kind, "channel": channel},
    }
    result = simulate(load_scenario("quadrilateral", overrides=overrides), engine=engine)
    assert (result["channel"].values.tolist() if "traffic" in result else []) == told
    assert metrics(result).messages_sent == (pytest.approx(10 * len(told), abs=len(told)) if told else None)
