"""What becomes of packets that share a medium: laws of access that textbooks know."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from drake_formation.parts.channels.packets import Packets
from drake_formation.parts.media import access
from drake_formation.parts.media import medium_law as law
from drake_formation.parts.registry import find

BITS = 256.0


class Air:
    """A medium alone, to which packets are offered by hand.

    Args:
        kind: of the medium.
        pairs: listener and speaker of every channel, from 0.
        period: how often the channels look (s).
        given: fields of the medium.
    """

    def __init__(self, kind, pairs, period, seed=1, bits=BITS, places=None, **given):
        self.part = find("medium", kind)(find("medium", kind).Config(**given))
        channel = Packets(Packets.Config(period=period, bits=bits))
        robots = 1 + int(np.max(pairs))
        formation = SimpleNamespace(
            channels=SimpleNamespace(pairs=np.array(pairs)), parts={"channel": (channel,) * len(pairs)}, seed=seed,
            robots=robots,
        )  # fmt: skip
        self.period, self.channels, self.looks = period, len(pairs), 0
        self.numbers = np.concatenate(self.part.numbers(formation, 0))
        self.state = np.concatenate(self.part.initial_discrete_state(formation, 0))
        self.inputs = np.zeros(access.TRAFFIC_PORT * self.channels + access.STATE_PORT * robots)
        self.offered = self.inputs[: access.TRAFFIC_PORT * self.channels : access.TRAFFIC_PORT]
        if places is not None:
            self.inputs[access.TRAFFIC_PORT * self.channels :: access.STATE_PORT] = places

    def pass_by(self, carry=law.SHARE):
        """One time from a look to the next."""
        carry((self.looks + 0.5) * self.period, self.inputs, self.state, self.numbers)
        self.looks += 1

    @property
    def reports(self):
        """What every channel is told, shape (C, 5)."""
        size = access.REPORT * self.channels
        return self.state[access.REPORTS : access.REPORTS + size].reshape(self.channels, -1)

    @property
    def waiting(self):
        """Packets that wait or are in the air."""
        rows = self.state[access.station_row(0, self.numbers) :][: access.STATION * int(self.numbers[access.STATIONS])]
        rows = rows.reshape(-1, access.STATION)
        return int((rows[:, [access.WAITING, access.SENDING]] > 0).sum())


def far_apart(stations):
    """Stations that nobody but one listener hears."""
    return [[stations, speaker] for speaker in range(stations)]


@pytest.mark.parametrize("load", [0.5, 1.0, 2.0])
def test_slotted_aloha_carries_as_known(load):
    stations, slots = 100, 100_000
    air = Air("aloha", far_apart(stations), 1e-3, bit_rate=BITS / 1e-3, probability=load / stations, retries=0, seed=3)
    for _ in range(slots):
        air.offered[:] += 1
        air.pass_by()
    assert air.state[access.CARRIED] / slots == pytest.approx(load * np.exp(-load), rel=0.01)
    assert air.state[access.AIRTIME] / (slots * 1e-3) == pytest.approx(load, rel=0.01)


def test_csma_carries_as_bianchi_says():
    stations, window, doublings, frame, slot = 10, 16, 6, 40, 2e-5
    air = Air(
        "csma", far_apart(stations), 0.1, bits=frame, bit_rate=1 / slot, slot=slot, window=window, doublings=doublings,
        retries=1000,
    )  # fmt: skip
    air.period = frame * slot / 4
    air.numbers[access.HALF] = air.period / 2
    for _ in range(40_000):
        air.offered[:] += air.offered < air.reports[:, access.DECIDED] + 2  # there is always one
        air.pass_by()

    def beyond(chance):  # Bianchi 2000, Eqs. 7 and 9
        busy = 1 - (1 - chance) ** (stations - 1)
        tries = 2 * (1 - 2 * busy) / ((1 - 2 * busy) * (window + 1) + busy * window * (1 - (2 * busy) ** doublings))
        return chance - tries

    chance = brentq(beyond, 1e-4, 0.5)
    some = 1 - (1 - chance) ** stations
    alone = stations * chance * (1 - chance) ** (stations - 1)
    expected = alone * frame / (1 - some + some * frame)
    measured = air.state[access.CARRIED] * frame * slot / (air.looks * air.period)
    assert measured == pytest.approx(expected, rel=0.02)


def test_in_turns_nobody_collides_and_everybody_waits_for_his():
    air = Air("tdma", far_apart(5), 1e-2, bit_rate=BITS / 2e-3)
    for look in range(200):
        air.offered[:] += 1
        air.pass_by()
        np.testing.assert_allclose(air.reports[:, access.THROUGH], look * 1e-2 + 2e-3 * np.arange(1, 6), atol=1e-12)
    assert air.state[access.COLLIDED] == air.state[access.DROPPED] == air.waiting == 0
    assert air.state[access.AIRTIME] == pytest.approx(200 * 1e-2)


@pytest.mark.parametrize("load", [0.25, 0.5, 2.0, 4.0])
def test_turns_carry_all_that_they_can(load):
    stations = 4
    air = Air("tdma", far_apart(stations), 1e-2, bit_rate=BITS * stations * 1e2 / load)
    for _ in range(400):
        air.offered[:] += 1
        air.pass_by()
    slots = 400 * 1e-2 / air.numbers[access.SLOT]
    assert air.state[access.CARRIED] / slots == pytest.approx(min(1.0, load), abs=0.02)


def test_on_a_bus_the_first_waits_for_one_frame_at_most_and_the_last_starves():
    frame, look = 1e-3, 2.7e-3
    air = Air("priority", far_apart(6), look, bit_rate=BITS / frame)
    for k in range(500):
        air.offered[:] += 1
        air.pass_by()
        assert air.reports[0, access.NUMBER] == k + 1
        assert frame - 1e-9 <= air.reports[0, access.THROUGH] - k * look <= 2 * frame + 1 / (BITS / frame)
    assert air.state[access.COLLIDED] == 0
    assert air.reports[1, access.NUMBER] == 500
    assert air.reports[5, access.NUMBER] == 0
    assert air.state[access.AIRTIME] == pytest.approx(500 * look, rel=0.01)


@pytest.mark.parametrize(
    ("kind", "given"), [("tdma", {}), ("aloha", {"retries": 2}), ("csma", {"retries": 2}), ("priority", {})]
)
@pytest.mark.parametrize("rate", [5e4, 2e5, 1e6])
def test_what_is_offered_is_carried_dropped_or_waiting(kind, given, rate):
    pairs = [[i, j] for i in range(4) for j in range(4) if i != j]
    air = Air(kind, pairs, 1e-2, bit_rate=rate, **given)
    seen, carried = np.zeros(air.channels), 0
    for _ in range(300):
        air.offered[:] += 1
        air.pass_by()
        counts, now = air.state, air.reports
        assert counts[access.OFFERED] == counts[access.CARRIED] + counts[access.DROPPED] + air.waiting
        carried += (now[:, access.NUMBER] > seen).sum() + (now[:, access.BEFORE] > seen).sum()
        seen = now[:, access.NUMBER].copy()
    assert carried == air.state[access.CARRIED] > 0  # nobody misses one


def test_far_robots_do_not_disturb_each_other_and_a_hidden_one_does():
    pairs, rate = [[1, 0], [2, 3]], BITS / 1e-3
    near = Air("aloha", pairs, 1e-3, bit_rate=rate, probability=1.0, retries=0, places=[0, 1, 2, 3])
    far = Air("aloha", pairs, 1e-3, bit_rate=rate, probability=1.0, retries=0, range=1.5, places=[0, 1, 2, 3])
    hidden = Air("csma", [[1, 0], [1, 2]], 1e-2, bit_rate=rate, range=1.5, retries=0, places=[0, 1, 2])
    heard = Air("csma", [[1, 0], [1, 2]], 1e-2, bit_rate=rate, range=2.5, retries=0, places=[0, 1, 2])
    for air in (near, far, hidden, heard):
        for _ in range(1000):
            air.offered[:] += 1
            air.pass_by()
    assert (near.state[access.CARRIED], far.state[access.CARRIED]) == (0, 2000)
    assert hidden.state[access.COLLIDED] == 2000  # 16 slots of 20 µs are less than a frame
    assert 0 < heard.state[access.COLLIDED] < 200


def test_noise_loses_more_the_farther_they_are():
    for apart, exponent in ((1.0, 3.0), (3.0, 3.0), (3.0, 2.0)):
        air = Air(
            "tdma", [[1, 0]], 1e-3, bit_rate=BITS / 1e-3, power=-30.0, exponent=exponent, places=[0, apart]
        )  # 15 dB to spare at 1 m
        for _ in range(20_000):
            air.offered[:] += 1
            air.pass_by()
        expected = np.exp(-(10**-1.5) * apart**exponent)
        assert air.state[access.CARRIED] / 20_000 == pytest.approx(expected, rel=0.02)


def test_what_is_broadcast_is_sent_once_for_all():
    pairs = [[i, j] for i in range(4) for j in range(4) if i != j]
    air = Air("tdma", pairs, 1e-2, bit_rate=BITS * 4 / 1e-2, broadcast=True)
    for _ in range(100):
        air.offered[:] += 1
        air.pass_by()
    assert air.state[access.CARRIED] == 1200
    assert air.state[access.AIRTIME] == pytest.approx(1.0)


@pytest.mark.parametrize("kind", ["tdma", "aloha", "csma", "priority"])
def test_compiled_and_in_python_it_is_the_same_law(kind):
    pairs = [[i, j] for i in range(4) for j in range(4) if i != j]
    radio = {} if kind == "priority" else {"power": -30.0, "range": 2.5}
    one, other = (Air(kind, pairs, 1e-2, bit_rate=3e5, places=[0, 1, 2, 3], **radio) for _ in range(2))
    for _ in range(30):
        for air, carry in ((one, law.SHARE), (other, law.share_medium)):
            air.offered[:] += 1
            air.pass_by(carry)
    np.testing.assert_array_equal(one.state, other.state)
