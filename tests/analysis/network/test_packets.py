"""What a tick does to a system with packets, against packets sent, queued and received one by one."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from strategies import generators

from drake_formation.analysis.network.packet_schedule import PacketChannel, schedule
from drake_formation.analysis.network.packets import packet_ticks

STATES = 3
DRIFT = np.array([[0.0, 1.0], [0.0, 0.0]])


@st.composite
def several(draw, most=3):
    rng = draw(generators)
    senders = rng.normal(size=(2, 2, STATES))
    return [
        PacketChannel(
            into=rng.normal(size=(STATES, 2)),
            sent=senders[draw(st.integers(0, 1))],
            period=draw(st.sampled_from([0.1, 0.2, 0.3])),
            delay=draw(st.sampled_from([0.0, 0.05, 0.1, 0.17, 0.4])),
            looks=draw(st.integers(1, 2)),
            phase=draw(st.sampled_from([0.0, 0.05])),
            loss=draw(st.sampled_from([0.0, 0.4])),
            drift=draw(st.sampled_from([None, DRIFT])),
        )
        for _ in range(draw(st.integers(1, most)))
    ]


@given(channels=several(), rng=generators)
@settings(max_examples=25)
def test_ticks_are_what_packets_do_one_by_one(channels, rng):
    present, state = rng.normal(size=(STATES, STATES)), rng.normal(size=STATES)
    times, ticks = schedule(channels), packet_ticks(present, channels)
    receivers = [Receiver(channel) for channel in channels]
    whole = np.concatenate([state, np.zeros(len(ticks[0].loop.base) - STATES)])
    for k in range(25):
        time = min(channel.phase for channel in channels) + k * times.tick
        arrived = [receiver.look(time, state, rng) for receiver in receivers]
        due = [c for c in range(len(channels)) if channels[c].loss and (k - times.first[c]) % times.every[c] == 0]
        loop = ticks[k % len(ticks)].loop
        step = loop.base + sum(loop.into[n] @ loop.out[n] for n, c in enumerate(due) if arrived[c])
        whole = step @ whole
        state = flown(present, receivers, state, time, time + times.tick)
        np.testing.assert_allclose(whole[:STATES], state, rtol=1e-7, atol=1e-7 * max(1.0, np.abs(whole).max()))


class Receiver:
    """Of one channel: what has been sent and not looked for, and what was heard last."""

    def __init__(self, channel):
        self.channel, self.under_way, self.heard, self.at = channel, [], np.zeros(channel.size), None

    def look(self, time, state, rng):
        """Send and receive what is due; whether something arrived."""
        channel, arrived = self.channel, False
        since = (time - channel.phase) / channel.period
        if since > -1e-9 and abs(since - round(since)) < 1e-9 and rng.random() >= channel.loss:
            self.under_way.append((time, channel.sent @ state))
        if abs(since * channel.looks - round(since * channel.looks)) < 1e-9:
            while self.under_way and self.under_way[0][0] + channel.delay <= time + 1e-9:
                self.at, self.heard = self.under_way.pop(0)
                arrived = True
        return arrived

    def now(self, time):
        """What it takes the sender's state for."""
        return self.heard if self.at is None else self.channel.goes_on(time - self.at) @ self.heard


def flown(present, receivers, state, begin, end):
    """The state at the end of a tick, integrated with what is heard going on meanwhile."""

    def rate(time, now):
        return present @ now + sum(receiver.channel.into @ receiver.now(time) for receiver in receivers)

    return solve_ivp(rate, (begin, end), state, rtol=1e-9, atol=1e-12, method="DOP853").y[:, -1]


def test_what_is_under_way_is_kept_once_for_all_that_hear_it():
    sent, into = np.eye(2), np.ones((2, 2))
    (tick,) = packet_ticks(-np.eye(2), [PacketChannel(into, sent, 0.1, 0.3), PacketChannel(2 * into, sent, 0.1, 0.2)])
    assert len(tick.loop.base) == 2 + 3 * 2
