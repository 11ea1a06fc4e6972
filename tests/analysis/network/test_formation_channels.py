"""The channel certificate of formations, and simulations on both sides of its boundaries."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from drake_formation import load_scenario, simulate
from drake_formation.analysis import channel_certificate, delay_margin, linearize
from drake_formation.parts.channels.delay import Delay
from drake_formation.parts.channels.packets import Packets

STEEL = {
    "consensus": {"delta": 1e4, "delta_v": 600.0},
    "springs.stiffness": 3e4,
    "aggregation.duration": 0.0,
    "avoidance": {"obstacles": []},
    "transport": {"duration": 20.0, "reference": {"kind": "set_point"}, "goal": [0.0, 0.0]},
}


@cache
def over_wires(name="line"):
    return linearize(load_scenario(name, overrides=STEEL))


def verdict(name="line", **channel):
    """Of a formation all of whose channels are alike."""
    formation = over_wires(name)
    kind = {"packets": Packets, "delay": Delay}[channel.pop("kind", "packets")]
    part = kind(kind.Config(**channel))
    return channel_certificate(replace(formation, channels=(part,) * len(formation.channels)))


def boundary(channel, low, high):
    """Where the label of the line turns from stable to unstable, of a channel that depends on one number."""
    while high - low > 1e-4 * high:
        middle = (low + high) / 2
        low, high = (middle, high) if verdict(**channel(middle)).label == "stable" else (low, middle)
    return low


CHANNELS = {
    "hold": (lambda s: {"period": s}, 0.05, 0.15),
    "late": (lambda s: {"period": s, "delay": 2 * s}, 0.02, 0.06),
    "predict": (lambda s: {"period": s, "missing": "predict"}, 0.02, 0.09),
    "looks": (lambda s: {"period": s, "delay": s, "looks": 4}, 0.02, 0.09),
    "pure delay": (lambda s: {"kind": "delay", "delay": s}, 0.02, 0.09),
}


@pytest.mark.slow
@pytest.mark.parametrize("case", CHANNELS)
def test_simulation_decays_below_the_boundary_and_grows_above(case):
    channel, low, high = CHANNELS[case]
    edge = boundary(channel, low, high)
    assert growth(channel(0.99 * edge)) < 0
    above = channel(1.01 * edge)
    assert growth(above) == pytest.approx(verdict(**above).growth_1_per_s, rel=0.05)


def test_a_pure_delay_is_certified_up_to_the_delay_margin():
    channel, low, high = CHANNELS["pure delay"]
    assert boundary(channel, low, high) == pytest.approx(delay_margin(over_wires()).delay_s, rel=2e-4)


def test_so_do_drakes_own_blocks():
    channel, low, high = CHANNELS["late"]
    edge = boundary(channel, low, high)
    rates = [growth(channel(share * edge), engine="blocks", **{"transport.duration": 8.0}) for share in (0.99, 1.01)]
    assert rates[0] < 0 < rates[1]


@pytest.mark.parametrize("seed", [1, 2])
def test_a_run_decays_where_losses_are_just_certified(seed):
    def lossy(share):
        return {"period": 0.05, "missing": "predict", "loss": share}

    edge = boundary(lossy, 0.3, 0.9)
    assert 0.5 < edge < 0.7
    assert verdict(**lossy(1.01 * edge)).label == "not certified"
    assert growth(lossy(0.99 * edge), seed=seed, **{"transport.duration": 100.0}) < 0


@pytest.mark.parametrize("profile", ["urllc", "factory", "wifi"])
@pytest.mark.parametrize("delta_v", [0.0, 600.0])
def test_no_run_contradicts_the_label_of_a_profile(profile, delta_v):
    changes = {"consensus.delta_v": delta_v, "consensus.channel": {"kind": "packets", "profile": profile}}
    label = channel_certificate(linearize(load_scenario("line", overrides=STEEL | changes))).label
    assert label == ("stable" if delta_v else "unstable")
    _, size = swings({"profile": profile}, **{"consensus.delta_v": delta_v, "transport.duration": 8.0})
    assert (size[-20:].max() < size[0]) == (label == "stable")


@given(scenario=scenarios(robots=st.integers(2, 4)))
@settings(max_examples=12)
def test_channels_that_hardly_delay_are_wires(scenario):
    formation = linearize(scenario)
    roots = np.linalg.eigvals(formation.A)
    slowest = roots.real.max()
    part = Delay(Delay.Config(delay=min(1.0, 1e-2 * abs(slowest) / np.abs(roots).max() ** 2)))
    found = channel_certificate(replace(formation, channels=(part,) * len(formation.channels)))
    assert found is None or found.growth_1_per_s == pytest.approx(slowest, rel=0.1)


def test_wires_have_no_verdict_of_their_own():
    assert channel_certificate(over_wires()) is None
    assert verdict(kind="delay", delay=0.0) is None
    assert verdict(profile="ideal") is None


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"trigger": 0.1}, "moved far enough"),
        ({"delay": 0.02, "spread": 0.01}, "differ from packet to packet"),
        ({"delay": 0.02, "spread": 0.01, "distribution": "gamma"}, "differ from packet to packet"),
        ({"delays": (0.0, 0.02)}, "differ from packet to packet"),
        ({"loss": 0.1, "burst": 4.0}, "in bursts"),
        ({"losses": (0.0, 1.0)}, "as measured"),
        ({"loss": 1.0}, "every packet"),
        ({"quantum": 0.01}, "rounded"),
        ({"clock_drift": 0.01}, "drift apart"),
        ({"clock_offset": 0.01, "missing": "predict"}, "older or newer"),
        ({"order": "buffer", "playout": 0.01, "delay": 0.02}, "later than they are to be used"),
        ({"outages": ((1.0, 2.0),)}, "down at times"),
        ({"failure_rate": 0.1, "repair_rate": 1.0}, "down at times"),
        ({"range": 0.9}, "out of each other's reach"),
        ({"missing": "zero", "loss": 0.1}, "its own term"),
        ({"timeout": 0.5, "loss": 0.1}, "dropped"),
        ({"delay": 100.0}, "too many"),
    ],
)
def test_what_is_not_certified_says_why(given, reason):
    found = verdict(**given)
    assert found.label == "not certified"
    assert reason in found.reason


@pytest.mark.parametrize(
    "given",
    [
        {"order": "in_order", "delay": 0.01},
        {"order": "buffer", "playout": 0.01, "delay": 0.003},
        {"delay": 0.005, "spread": 0.004, "clock_offset": 0.1, "timeout": 1.0, "range": 2.0},
        {"missing": "zero", "delays": (0.01, 0.004)},
    ],
)
def test_what_makes_no_difference_makes_none(given):
    assert verdict(**given) == verdict(delay=0.01)


def test_channel_by_channel_is_as_all_alike():
    """Settings that differ and mean the same: packets that the receiver has at the next tick, one way or the other."""
    formation, alike = over_wires("quadrilateral"), verdict("quadrilateral", delay=0.01)
    others = [Packets(Packets.Config(delay=0.01 - k / 1e4)) for k in range(len(formation.channels))]
    found = channel_certificate(replace(formation, channels=tuple(others)))
    assert found.label == alike.label == "stable"
    assert found.growth_1_per_s == pytest.approx(alike.growth_1_per_s, rel=1e-6)
    late = [Delay(Delay.Config(delay=0.03 + 1e-9 * k)) for k in range(len(formation.channels))]
    pure = channel_certificate(replace(formation, channels=tuple(late)))
    expected = verdict("quadrilateral", kind="delay", delay=0.03).growth_1_per_s
    assert pure.growth_1_per_s == pytest.approx(expected, rel=1e-4)


def test_channels_of_different_kinds():
    formation = over_wires()
    packets, delay, wire = Packets(Packets.Config()), Delay(Delay.Config(delay=0.01)), Delay(Delay.Config(delay=0.0))
    mixed = channel_certificate(replace(formation, channels=(packets, delay)))
    assert (mixed.label, "others are pure delays" in mixed.reason) == ("not certified", True)
    assert channel_certificate(replace(formation, channels=(packets, wire))).label == "stable"
    assert channel_certificate(replace(formation, channels=(delay, wire))).label == "stable"


def growth(channel, engine="compiled", **more):
    """Rate at which two robots, pulled apart and let go, swing (1/s)."""
    times, size = swings(channel, engine, **more)
    early, late = 0.3 * times[-1], 0.9 * times[-1]
    peaks = [size[(times >= begin) & (times < begin + 0.1 * times[-1])].max() for begin in (early, late)]
    return np.log(peaks[1] / peaks[0]) / (late - early)


def swings(channel, engine="compiled", **more):
    """Times (s), and how far they are from where they are to be from each other (m)."""
    start = {"robots.start": [[-1e-4, -0.5001], [1e-4, 0.5001]], "consensus.channel": {"kind": "packets"} | channel}
    run = simulate(load_scenario("line", overrides=STEEL | start | more), engine=engine)
    apart = np.diff(run["position"].values, axis=1)[:, 0] - np.diff(run["slot"].values, axis=0)[0]
    return run["time"].values, np.linalg.norm(apart, axis=1)


def test_channels_that_share_a_medium_are_not_certified():
    found = channel_certificate(linearize(load_scenario("shared-medium")))
    assert found.label == "not certified"
    assert "share a medium" in found.reason
