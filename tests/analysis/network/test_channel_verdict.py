"""Verdicts on either side of known boundaries: sampling, delay, loss."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import generators

from drake_formation.analysis import stable_delays, stable_periods
from drake_formation.analysis.network.channel_verdict import delay_verdict, packet_verdict
from drake_formation.analysis.network.packet_schedule import PacketChannel
from drake_formation.analysis.network.packets import packet_ticks

PLANT = np.array([[0.0, 1.0], [0.0, -0.1]])
FEEDBACK = -np.array([[0.0], [0.1]]) @ np.array([[3.75, 11.5]])


def over(**settings):
    return packet_verdict(PLANT, [PacketChannel(FEEDBACK, np.eye(2), **settings)]).label


def test_both_sides_of_the_sampling_limit():
    (stable,) = stable_periods(PLANT, FEEDBACK, up_to=5.0)
    assert over(period=round(0.999 * stable.high, 4)) == "stable"
    assert over(period=round(1.001 * stable.high, 4)) == "unstable"


def test_packets_that_come_often_are_a_delay_and_half_a_period():
    (stable,) = stable_delays(PLANT, FEEDBACK)
    assert over(period=0.01, delay=round(stable.high - 0.02, 2)) == "stable"
    assert over(period=0.01, delay=round(stable.high + 0.01, 2)) == "unstable"
    assert over(period=0.2, delay=1.0, looks=10) == "stable"
    assert over(period=0.2, delay=1.1, looks=10) == "unstable"  # another half period is 1.2 s


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_both_sides_of_a_pure_delay(share):
    (stable,) = stable_delays(PLANT, FEEDBACK)
    verdict = delay_verdict(PLANT, [(FEEDBACK / 3, share * stable.high), (2 * FEEDBACK / 3, share * stable.high)])
    assert verdict.label == ("stable" if share < 1 else "unstable")


def moments(tick, length):
    """E[Φ ⊗ Φ] over what arrives, each channel or not."""
    found = 0.0
    for pattern in np.ndindex(*[2] * length):
        step = tick.loop.base + sum(tick.loop.into[c] @ tick.loop.out[c] for c in np.flatnonzero(pattern))
        share = np.prod(np.where(pattern, tick.arrival, 1 - tick.arrival))
        found = found + share * np.kron(step, step)
    return found


@given(rng=generators, channels=st.integers(1, 3), late=st.integers(0, 1))
@settings(max_examples=40)
def test_losses_are_certified_exactly_where_the_second_moment_decays(rng, channels, late):
    present = rng.normal(size=(2, 2)) - rng.uniform(0, 2) * np.eye(2)
    links = [
        PacketChannel(
            rng.normal(size=(2, 1)), rng.normal(size=(1, 2)), 0.5, 0.5 * late, loss=rng.choice([0.1, 0.5, 0.9])
        )
        for _ in range(channels)
    ]
    (tick,) = packet_ticks(present, links)
    second = np.abs(np.linalg.eigvals(moments(tick, channels))).max()
    mean = np.abs(np.linalg.eigvals(tick.mean)).max()
    expected = "stable" if second < 1 else "unstable" if mean > 1 else "not certified"
    if min(abs(second - 1), abs(mean - 1)) > 1e-6:
        assert packet_verdict(present, links).label == expected


@given(rng=generators, looks=st.integers(1, 3))
@settings(max_examples=25)
def test_so_they_are_where_ticks_differ(rng, looks):
    present = rng.normal(size=(2, 2)) - rng.uniform(0, 2) * np.eye(2)
    links = [
        PacketChannel(rng.normal(size=(2, 1)), rng.normal(size=(1, 2)), period, 0.1, looks, loss=0.5)
        for period in (0.6, 0.9)
    ]
    ticks = packet_ticks(present, links)
    second = np.eye(len(ticks[0].loop.base) ** 2)
    mean = np.eye(len(ticks[0].loop.base))
    for tick in ticks:
        second, mean = moments(tick, len(tick.arrival)) @ second, tick.mean @ mean
    radii = [np.abs(np.linalg.eigvals(matrix)).max() for matrix in (second, mean)]
    expected = "stable" if radii[0] < 1 else "unstable" if radii[1] > 1 else "not certified"
    if min(abs(radius - 1) for radius in radii) > 1e-6:
        assert packet_verdict(present, links).label == expected


def test_what_cannot_be_told_says_why():
    one = np.eye(1)
    unequal = [PacketChannel(-0.1 * one, one, 0.1, 8.0, loss=0.1), PacketChannel(-0.1 * one, one, 2.3, loss=0.1)]
    assert "23 ticks that differ" in packet_verdict(-one, unequal).reason
    assert "rounding" in packet_verdict(0 * one, [PacketChannel(0 * one, one, 0.1)]).reason
    assert "rounding" in delay_verdict(0 * one, []).reason
    late = packet_verdict(-one, [PacketChannel(-one, one, 1e-3, 2.0)])
    assert (late.label, late.growth_1_per_s) == ("not certified", None)
    assert "too many" in late.reason
    uneven = [PacketChannel(-one, one, 0.1), PacketChannel(-one, one, 0.123)]
    assert "no common tick" in packet_verdict(-one, uneven).reason
