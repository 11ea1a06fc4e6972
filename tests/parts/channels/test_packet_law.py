"""What becomes of packets on their way."""

import numpy as np
import pytest
from scipy import stats

from drake_formation.parts.channels import packet_law as law
from drake_formation.parts.channels.packets import Packets
from drake_formation.systems.random_stream import random_start

STILL = np.array([1.0, 2.0, 0.5, 0.0])


def settings(**given):
    """The parameters of a channel alone, without a formation."""

    class Alone:
        channels = type("Channels", (), {"pairs": np.array([[0, 1]])})
        slots = np.zeros((2, 2))
        has_medium = False

    channel = Packets(Packets.Config(**given))
    return np.concatenate(channel.numbers(Alone, 0)), channel


def start(rows=64, seed=0):
    memory = [*random_start(seed, "channel_2_to_1"), 0, 0, *STILL[:2], 0, 0, 1, 0]
    return np.array([*STILL, 0, 1, 0, 0, 0, 0, 0, 0, *memory, *[0.0] * law.ROW * rows])


def run(count, inputs=lambda time: STILL, carry=law.CARRY, seed=0, **given):
    """State after every look of a channel, shape (count, …), and the times."""
    numbers, channel = settings(**given)
    step, phase = channel.timing
    state, seen, times = start(seed=seed), [], phase + step * np.arange(count)
    for time in times:
        carry(time, np.ascontiguousarray(inputs(time), dtype=float), state, numbers)
        seen.append(state.copy())
    return times, np.array(seen)


def moving(time):
    return np.array([time, 0.0, 1.0, 0.0])


def test_without_delay_a_packet_is_there_at_once():
    times, seen = run(50, moving)
    np.testing.assert_array_equal(seen[:, 0], times)
    assert seen[-1, law.DELIVERED] == seen[-1, law.FRESHLY_SENT] == 50


@pytest.mark.parametrize(("delay", "looks", "later"), [(0.01, 1, 1), (0.03, 1, 3), (0.025, 1, 3), (0.025, 4, 10)])
def test_a_packet_is_taken_at_the_first_look_after_its_delay(delay, looks, later):
    times, seen = run(80, moving, delay=delay, looks=looks)
    sent = times[looks * np.arange(2, 10)]
    arrived = looks * np.arange(2, 10) + later
    np.testing.assert_allclose(seen[arrived, 0], sent, atol=1e-15)
    assert (seen[arrived - 1, 0] < sent).all()


def test_compiled_and_in_python_it_is_the_same_law():
    given = {"profile": "lossy", "distribution": "gamma", "failure_rate": 2.0, "repair_rate": 5.0, "quantum": 0.01}
    _, compiled = run(300, moving, **given)
    _, read = run(300, moving, carry=law.carry_packets, **given)
    np.testing.assert_allclose(compiled, read, rtol=1e-12)  # cosines differ in the last digit


@pytest.mark.parametrize("distribution", ["uniform", "gamma"])
def test_delays_are_distributed_as_they_say(distribution):
    numbers, _ = settings(delay=0.05, spread=0.02, distribution=distribution)
    state = start()
    drawn = np.array([law.drawn_delay(1.0, state, numbers) for _ in range(4000)])
    shape = (0.05 / 0.02) ** 2
    known = {"uniform": stats.uniform(0.03, 0.04), "gamma": stats.gamma(shape, scale=0.05 / shape)}[distribution]
    assert stats.kstest(drawn, known.cdf).pvalue > 0.01


@pytest.mark.parametrize(("burst", "burst_loss"), [(1.0, 1.0), (5.0, 1.0), (8.0, 0.5)])
def test_the_share_of_lost_packets_is_as_set(burst, burst_loss):
    _, seen = run(60_000, loss=0.1, burst=burst, burst_loss=burst_loss)
    lost = np.diff(seen[:, law.LOST], prepend=0.0)
    assert lost.mean() == pytest.approx(0.1, abs=0.01)
    if burst_loss == 1.0:
        lengths = np.diff(np.flatnonzero(np.diff(lost, prepend=0.0, append=0.0)))[::2]
        expected = burst if burst > 1 else 1 / 0.9
        assert lengths.mean() == pytest.approx(expected, rel=0.08)


def test_packets_that_overtake_are_counted_and_what_they_passed_is_late():
    times, seen = run(12, moving, delays=(0.05, 0.0, 0.0), period=0.01)
    last = seen[-1]
    assert last[law.OVERTAKEN] == 4
    assert last[law.LATE] == 3  # those sent at 0, 0.03 and 0.06; the one sent at 0.09 is on its way
    assert (np.diff(seen[:, law.SENT_AT]) >= 0).all()
    assert times[-1] == pytest.approx(seen[-1, law.SENT_AT])


def test_in_order_waits_for_those_that_were_passed():
    _, seen = run(12, moving, delays=(0.05, 0.0, 0.0), period=0.01, order="in_order")
    taken = seen[:, law.TAKEN]
    assert taken.tolist() == [0, 0, 0, 0, 0, 3, 3, 3, 6, 6, 6, 9]
    assert seen[-1, law.LATE] == 0


def test_a_buffer_gives_every_packet_the_same_delay_and_throws_late_ones_away():
    times, seen = run(40, moving, delays=(0.01, 0.03, 0.02, 0.06), period=0.01, order="buffer", playout=0.04)
    used = np.flatnonzero(np.diff(seen[:, law.TAKEN]) > 0) + 1
    np.testing.assert_allclose(times[used] - seen[used, law.SENT_AT], 0.04, atol=1e-12)
    assert seen[-1, law.LATE] == (40 - 6) // 4


def test_a_clock_that_is_ahead_and_fast_sends_more_and_stamps_so():
    _, seen = run(1001, clock_offset=0.25, clock_drift=0.1, period=0.01, looks=10)
    times = seen[-1, law.SENT_AT]
    assert seen[-1, 4] == pytest.approx(1.1 * times + 0.25)
    assert seen[-1, law.FRESHLY_SENT] == pytest.approx(111, abs=1)


def test_quantization_rounds_to_the_nearest_step():
    _, seen = run(1, lambda _: np.array([0.126, -0.124, 1.04, -1.06]), quantum=0.05)
    np.testing.assert_allclose(seen[0, :4], [0.15, -0.10, 1.05, -1.05], atol=1e-12)


def test_a_robot_that_does_not_move_has_nothing_to_tell():
    assert run(50, trigger=0.01)[1][-1, law.FRESHLY_SENT] == 0
    assert run(101, moving, trigger=0.095)[1][-1, law.FRESHLY_SENT] == 1 + 10


def test_nothing_comes_through_an_outage_or_beyond_the_range():
    times, seen = run(100, moving, outages=((0.205, 0.405),))
    lost = times[np.diff(seen[:, law.LOST], prepend=0.0) > 0]
    assert lost[0] == pytest.approx(0.21)
    assert lost[-1] == pytest.approx(0.40)
    far = run(100, lambda time: np.concatenate([moving(time), np.zeros(4)]), range=0.5)[1]
    assert far[-1, law.DELIVERED] == 51


def test_links_fail_and_are_repaired_at_their_rates():
    _, seen = run(100_000, failure_rate=0.5, repair_rate=2.0)
    assert seen[-1, law.LOST] / 1e5 == pytest.approx(0.5 / 2.5, rel=0.1)
    assert run(20_000, failure_rate=0.5)[1][-1, law.UP] == 0.0


def test_a_neighbour_is_dropped_after_the_timeout_and_heard_again():
    times, seen = run(100, outages=((0.2, 0.5),), timeout=0.1)
    dropped = times[seen[:, 5] == 0.0]
    assert dropped[0] == pytest.approx(0.30)
    assert dropped[-1] == pytest.approx(0.49)


def test_a_full_queue_loses_packets():
    numbers, channel = settings(delay=10.0, spread=0.0, period=0.01)
    assert channel.structure()[-1] >= 1000
    state = start(rows=4)
    for k in range(10):
        law.CARRY(0.01 * k, STILL, state, numbers)
    assert state[law.LOST] == 6
