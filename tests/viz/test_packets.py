"""Packets are shown from when they were sent to when they were taken, and as many lost ones as were lost."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation import load_scenario, simulate
from drake_formation.viz.packets import Packets, heard, packets_of, thinned
from drake_formation.viz.playback import Playback

SHORT = {"aggregation.duration": 1.0, "transport.duration": 2.0, "consensus.delta": 40.0}
CHANNEL = {"kind": "packets", "period": 0.1, "delay": 0.25, "distribution": "constant", "losses": [0.0, 0.0, 1.0]}


@pytest.fixture(scope="module")
def playback():
    return Playback(simulate(load_scenario("line", overrides=SHORT | {"consensus.channel": CHANNEL}), engine="blocks"))


def test_used_packets_fly_from_when_they_were_sent_to_when_the_receiver_looked(playback):
    packets = packets_of(playback)
    used = packets.some(~packets.lost & (packets.start > 0.95))
    sent = [0.1 * k for k in range(10, 27) if k % 3 != 2]
    for channel in (0, 1):
        np.testing.assert_allclose(used.start[used.channel == channel], sent, atol=1e-9)
    np.testing.assert_allclose(used.end - used.start, 0.3)  # 0.25 s, and the receiver looks ten times a second


def test_lost_packets_are_as_many_as_were_lost_and_when_they_were(playback):
    packets = packets_of(playback)
    lost = packets.some(packets.lost)
    for channel in (0, 1):
        np.testing.assert_allclose(lost.start[lost.channel == channel], np.arange(0.2, 2.95, 0.3), atol=1e-9)


def test_a_packet_goes_straight_from_who_speaks_to_who_hears(playback):
    packets = packets_of(playback)
    used = packets.some(~packets.lost)
    listener, speaker = playback.formation.channels.pairs[used.channel].T
    each = np.arange(len(used))
    begins, ends = playback.positions(used.start)[each, speaker], playback.positions(used.end)[each, listener]
    for share in (0.0, 0.25, 1.0):
        places = used.places(playback, used.start + share * (used.end - used.start))
        np.testing.assert_allclose(places, begins + share * (ends - begins), atol=1e-9)


def test_lost_packets_are_half_way(playback):
    packets = packets_of(playback)
    lost = packets.some(packets.lost)
    middles = playback.positions(lost.start).mean(axis=1)
    np.testing.assert_allclose(lost.places(playback, lost.start), middles, atol=1e-9)


@given(st.integers(0, 2**32 - 1).map(np.random.default_rng), st.integers(0, 200), st.integers(1, 50), st.integers(1, 9))
def test_no_more_packets_are_left_than_may_be_and_all_if_they_may(random, count, most, at_once):
    starts = np.sort(random.uniform(0.0, 10.0, count))
    ends = starts + random.uniform(0.01, 1.0, count)
    packets = Packets(np.zeros(count, dtype=np.intp), starts, ends, random.random(count) < 0.3, count)
    moments = np.concatenate([starts, ends])
    assert packets.at_once == max((int(packets.under_way(moment).sum()) for moment in moments), default=0)
    chosen = thinned(packets, most, at_once)
    assert len(chosen) <= most
    assert chosen.at_once <= at_once
    assert bool(count) == bool(len(chosen))
    if count <= most and packets.at_once <= at_once:
        assert len(chosen) == count


@pytest.mark.parametrize(("timeout", "silent"), [({}, (1.4, 2.3)), ({"timeout": 0.3}, (0.65, 2.3))])
def test_a_channel_is_heard_while_what_is_known_over_it_is_young_and_its_time_out_not_over(timeout, silent):
    channel = {"kind": "packets", "period": 0.05, "outages": {"1-2": [[0.4, 2.25]]}} | timeout
    result = simulate(load_scenario("line", overrides=SHORT | {"consensus.channel": channel}), engine="blocks")
    playback = Playback(result)
    first, last = silent
    told = heard(playback, np.array([0.0, first - 0.05, first + 0.05, last - 0.05, last + 0.05]))
    one_to_two = playback.formation.channels.labels.index("1-2")
    assert told[:, one_to_two].tolist() == [True, True, False, False, True]
    assert told[:, 1 - one_to_two].all()
