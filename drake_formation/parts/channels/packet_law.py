"""What becomes of packets on their way: the update of a packet channel, on plain arrays.

The functions are in the Python that numba compiles; :data:`CARRY` is the law. Time is in seconds, places in metres, in
the world frame. A packet is on its way in one row of the queue: its number, when it arrives, when it was sent by the
sender's clock and by the true one, whether a later one arrives before it, and the state it carries. Number 0 is a free
row. Where channels share a medium, a packet waits in its row until the medium says that it is through.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.systems.random_stream import advance, next_uniform
from drake_formation.systems.sampled_law import SampledLaw

Array = NDArray[np.float64]

HEARD, TRAFFIC, MEMORY, ROW = 6, 6, 10, 9
"""Sizes of the groups of discrete state; the last is that of a row of the queue."""
FRESHLY_SENT, LOST, DELIVERED, OVERTAKEN, LATE, SENT_AT = range(6, 12)
"""Where traffic is counted, and when what is taken for the neighbour's state was sent."""
DRAWN, BURST, SLOTS, LAST, TAKEN, HEARD_AT, UP, SWITCH = 12, 14, 15, 16, 18, 19, 20, 21
"""Where the channel remembers: its random stream, whether losses come in a burst, how many times of sending have
passed, the place sent last, the number taken last, when something was heard last, whether the link is up and when that
changes.
"""
QUEUE = HEARD + TRAFFIC + MEMORY
PERIOD, PHASE, DELAY, SPREAD, DISTRIBUTION, LOSS, BURST_LENGTH, BURST_LOSS, QUANTUM, OFFSET = range(10)
DRIFT, TRIGGER, ORDER, PLAYOUT, ZERO, TIMEOUT, FAILURES, REPAIRS, RANGE, DELAYS, LOSSES, OUTAGES, MEDIUM = range(10, 23)
"""Where the settings stand among the parameters. ``DELAYS``, ``LOSSES`` and ``OUTAGES`` are lengths of the tables that
follow them; ``MEDIUM`` says where among the inputs the medium's report is, 0 for none.
"""
SETTINGS = 23
CONSTANT, UNIFORM, GAMMA, MEASURED = range(4)
"""Distributions of delays."""
NEWEST, IN_ORDER, BUFFERED = range(3)
"""What a receiver does with what has arrived."""
ROUNDING = 1e-9
"""By how much a sum of times may be off (s)."""
WAITING = 1e300
"""When a packet arrives that waits for the medium (s)."""


def carry_packets(time: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Send what is due, and take what has arrived.

    Args:
        time: time (s).
        inputs: the state of the robot that speaks; where the channel asks for it, of the one that hears; and where
            there is a medium, what it reports.
        state: as the groups of :class:`drake_formation.parts.channels.packet_channel.PacketChannel`; updated.
        numbers: the settings, then the tables of measured delays (s), losses (1: lost) and outages (from, to; s).
    """
    if numbers[MEDIUM] > 0.0:
        hear_of_medium(inputs, state, numbers)
    clock = (time - numbers[PHASE]) * (1.0 + numbers[DRIFT]) / numbers[PERIOD] + ROUNDING
    if clock >= state[SLOTS]:
        state[SLOTS] = math.floor(clock) + 1.0
        send(time, inputs, state, numbers)
    taken = state[TAKEN]
    while take_next(time, state, numbers):
        pass
    if state[TAKEN] > taken:
        state[HEARD_AT] = time
    silent = state[TAKEN] == taken and numbers[ZERO] > 0.0
    state[5] = 0.0 if silent or time - state[HEARD_AT] > numbers[TIMEOUT] else 1.0


def send(time: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Put a packet on its way, unless there is nothing new to tell; it may be lost."""
    moved = math.hypot(inputs[0] - state[LAST], inputs[1] - state[LAST + 1])
    if numbers[TRIGGER] > 0.0 and moved <= numbers[TRIGGER]:
        return
    state[LAST], state[LAST + 1] = inputs[0], inputs[1]
    state[FRESHLY_SENT] += 1.0
    if numbers[MEDIUM] > 0.0:
        state[LOST] += 0.0 if enqueue(time, WAITING, inputs, state, numbers) else 1.0
        return
    number = state[FRESHLY_SENT]
    lost, delay = is_lost(number, state, numbers), drawn_delay(number, state, numbers)
    if lost or not is_up(time, inputs, state, numbers) or not enqueue(time, time + delay, inputs, state, numbers):
        state[LOST] += 1.0


def hear_of_medium(inputs: Array, state: Array, numbers: Array) -> None:
    """Let packets depart that the medium has carried since, at most two of them; what else it is done with is lost."""
    report = int(numbers[MEDIUM])
    for carried in range(report + 2, report - 1, -2):
        for row in range(QUEUE, state.size, ROW):
            if state[row] > 0.0 and state[row] == inputs[carried] and state[row + 1] == WAITING:
                depart(row, inputs[carried + 1], inputs, state, numbers)
    for row in range(QUEUE, state.size, ROW):
        if 0.0 < state[row] <= inputs[report + 4] and state[row + 1] == WAITING:
            state[row] = 0.0
            state[LOST] += 1.0


def depart(row: int, through: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Put a packet on its way that has come through the medium; it may be lost still."""
    number = state[row]
    lost, delay = is_lost(number, state, numbers), drawn_delay(number, state, numbers)
    if lost or not is_up(through, inputs, state, numbers):
        state[row] = 0.0
        state[LOST] += 1.0
    else:
        state[row + 1] = through + delay
        overtake(number, through + delay, state)


def draw(state: Array) -> float:
    """A number between 0 and 1 from the channel's stream."""
    value, first, second = next_uniform(state[DRAWN], state[DRAWN + 1])
    state[DRAWN], state[DRAWN + 1] = first, second
    return float(value)


def is_lost(number: float, state: Array, numbers: Array) -> bool:
    """Whether the packet is lost: measured, independently, or in bursts (Gilbert 1960; Elliott 1963).

    The channel is good, where nothing is lost, or bad; bad times are geometric, and so often that the share of lost
    packets is as set.
    """
    if numbers[LOSSES] > 0.0:
        start = SETTINGS + int(numbers[DELAYS])
        return bool(numbers[start + (int(number) - 1) % int(numbers[LOSSES])] > 0.0)
    if numbers[LOSS] == 0.0:
        return False
    if numbers[BURST_LENGTH] <= 1.0:
        return bool(draw(state) < numbers[LOSS])
    bad = numbers[LOSS] / numbers[BURST_LOSS]
    leaves = 1.0 / numbers[BURST_LENGTH]
    chance = draw(state)
    if state[BURST] > 0.0:
        state[BURST] = 0.0 if chance < leaves else 1.0
    else:
        state[BURST] = 1.0 if chance < leaves * bad / (1.0 - bad) else 0.0
    return bool(state[BURST] > 0.0 and draw(state) < numbers[BURST_LOSS])


def drawn_delay(number: float, state: Array, numbers: Array) -> float:
    """How long the packet is on its way (s); its distribution has the mean and the spread that are set."""
    kind, mean, spread = numbers[DISTRIBUTION], numbers[DELAY], numbers[SPREAD]
    if kind == MEASURED:
        return float(numbers[SETTINGS + (int(number) - 1) % int(numbers[DELAYS])])
    if kind == UNIFORM:
        return float(mean + spread * (2.0 * draw(state) - 1.0))
    if kind == GAMMA and spread > 0.0:
        return float(spread * spread / mean * gamma(state, (mean / spread) ** 2))
    return float(mean)


def gamma(state: Array, shape: float) -> float:
    """A number of the gamma distribution of some shape and scale 1 (Marsaglia & Tsang 2000)."""
    share = draw(state) ** (1.0 / shape) if shape < 1.0 else 1.0
    third = (shape + 1.0 if shape < 1.0 else shape) - 1.0 / 3.0
    while True:
        near, angle = draw(state), draw(state)
        normal = math.sqrt(-2.0 * math.log(near)) * math.cos(2.0 * math.pi * angle)
        cube = (1.0 + normal / (3.0 * math.sqrt(third))) ** 3
        if cube > 0.0 and math.log(draw(state)) < 0.5 * normal * normal + third * (1.0 - cube + math.log(cube)):
            return share * third * cube


def is_up(time: float, inputs: Array, state: Array, numbers: Array) -> bool:
    """Whether the link carries a packet now: no outage is planned, it has not failed, and the robots are in range."""
    if numbers[FAILURES] > 0.0:
        if state[SWITCH] == 0.0:
            state[SWITCH] = time - math.log(draw(state)) / numbers[FAILURES]
        while state[SWITCH] <= time:
            state[UP] = 1.0 - state[UP]
            state[SWITCH] -= math.log(draw(state)) / numbers[FAILURES if state[UP] > 0.0 else REPAIRS]
        if state[UP] == 0.0:
            return False
    start = SETTINGS + int(numbers[DELAYS]) + int(numbers[LOSSES])
    for k in range(int(numbers[OUTAGES])):
        if numbers[start + 2 * k] <= time + ROUNDING and time + ROUNDING < numbers[start + 2 * k + 1]:
            return False
    if numbers[RANGE] > 0.0:
        return bool(math.hypot(inputs[0] - inputs[4], inputs[1] - inputs[5]) <= numbers[RANGE])
    return True


def overtake(number: float, arrival: float, state: Array) -> None:
    """Count the packets that were sent earlier and arrive later, each of them once."""
    for row in range(QUEUE, state.size, ROW):
        if 0.0 < state[row] < number and arrival < state[row + 1] < WAITING and state[row + 4] == 0.0:
            state[row + 4] = 1.0
            state[OVERTAKEN] += 1.0


def enqueue(time: float, arrival: float, inputs: Array, state: Array, numbers: Array) -> bool:
    """Put the packet into a free row of the queue; whether there was one."""
    free = -1
    for row in range(QUEUE, state.size, ROW):
        if state[row] == 0.0:
            free = row
    overtake(state[FRESHLY_SENT], arrival, state)
    if free < 0:
        return False
    state[free], state[free + 1], state[free + 3], state[free + 4] = state[FRESHLY_SENT], arrival, time, 0.0
    state[free + 2] = time * (1.0 + numbers[DRIFT]) + numbers[OFFSET]
    for k in range(4):
        quantum = numbers[QUANTUM]
        state[free + 5 + k] = quantum * math.floor(inputs[k] / quantum + 0.5) if quantum > 0.0 else inputs[k]
    return True


def take_next(time: float, state: Array, numbers: Array) -> bool:
    """Deal with the next packet that has arrived; whether there was one."""
    row = next_row(time, state, numbers)
    if row < 0:
        return False
    buffered = numbers[ORDER] == BUFFERED
    if state[row] < state[TAKEN] or (buffered and state[row + 1] > state[row + 2] + numbers[PLAYOUT] + ROUNDING):
        state[LATE] += 1.0
    else:
        for k in range(4):
            state[k] = state[row + 5 + k]
        state[4], state[SENT_AT], state[TAKEN] = state[row + 2], state[row + 3], state[row]
    state[DELIVERED] += 1.0
    state[row] = 0.0
    return True


def next_row(time: float, state: Array, numbers: Array) -> int:
    """Row of the packet to deal with next, −1 for none: the first that arrived, or in order the first that was sent."""
    found, first, arrived = -1, np.inf, False
    for row in range(QUEUE, state.size, ROW):
        if state[row] == 0.0:
            continue
        due = state[row + 1]
        if numbers[ORDER] == BUFFERED:
            due = max(due, state[row + 2] + numbers[PLAYOUT])
        rank = state[row] if numbers[ORDER] == IN_ORDER else due
        if rank < first or (rank == first and state[row] < state[found]):
            found, first = row, rank
            arrived = due <= time + ROUNDING
    return found if found >= 0 and arrived else -1


CONSTANTS: dict[str, Any] = {name: value for name, value in dict(globals()).items() if isinstance(value, int | float)}
CARRY = SampledLaw(
    carry_packets,
    *(advance, next_uniform, draw, is_lost, gamma, drawn_delay, is_up, overtake, enqueue),
    *(next_row, take_next, depart, hear_of_medium, send),
    constants=CONSTANTS,
)
"""The law."""
