"""Who may begin to send in a slot: the rules by which stations share a medium, on plain arrays.

The functions are in the Python that numba compiles; :mod:`drake_formation.parts.media.medium_law` calls them. Where
numbers stand in its arrays is said here.
"""

import math

import numpy as np
from numpy.typing import NDArray

from drake_formation.systems.random_stream import next_uniform

Array = NDArray[np.float64]

OFFERED, CARRIED, DROPPED, COLLIDED, AIRTIME = range(5)
"""What the medium counts: packets of channels, frames that collided, and the airtime of all frames (s)."""
DRAWN, NEXT = 5, 7
"""Its random stream, and the number of the slot to work through next."""
REPORTS = 8
"""Where what it reports to the channels begins."""
NUMBER, THROUGH, BEFORE, THROUGH_BEFORE, DECIDED = range(5)
REPORT = 5
"""Of a channel: number of the packet carried last and when it was through (s), the same of the one carried before that,
and the number up to which all are carried or dropped.
"""
WAITING, SENDING, BEGUN, ENDS, FAILED, BACKOFF, SEEN = range(7)
STATION = 7
"""Of a station: number of the packet that waits and of the one in the air (0 for none), the slots in which that began
and will have ended, how often it has failed in a row, how many idle slots it backs off, and the newest number offered.
"""
PROTOCOL, SLOT, HALF, RETRIES, RANGE, FADES, MARGIN, EXPONENT, PROBABILITY, WINDOW, WIDEST = range(11)
CHANNELS, STATIONS = 11, 12
SETTINGS = 13
"""Where the settings stand among the parameters; then come the tables of channels and of stations."""
SPEAKER, LISTENER, OWNER = range(3)
LINK = 3
"""Of a channel: the robots, from 0, and its station."""
LENGTH, DURATION, FIRST = range(3)
TURN = 3
"""Of a station: how many slots a frame takes, how long it is in the air (s), and its first channel."""
TDMA, ALOHA, CSMA, PRIORITY = range(4)
"""Rules of access."""
TRAFFIC_PORT, STATE_PORT = 6, 4
"""Sizes of what channels and robots tell the medium."""


def draw(state: Array) -> float:
    """A number between 0 and 1 from the medium's stream."""
    value, first, second = next_uniform(state[DRAWN], state[DRAWN + 1])
    state[DRAWN], state[DRAWN + 1] = first, second
    return float(value)


def station_row(station: int, numbers: Array) -> int:
    """Where the state of a station begins."""
    return REPORTS + REPORT * int(numbers[CHANNELS]) + STATION * station


def turn_row(station: int, numbers: Array) -> int:
    """Where the numbers of a station begin."""
    return SETTINGS + LINK * int(numbers[CHANNELS]) + TURN * station


def speaker_of(station: int, numbers: Array) -> int:
    """The robot that sends what a station sends."""
    first = int(numbers[turn_row(station, numbers) + FIRST])
    return int(numbers[SETTINGS + LINK * first + SPEAKER])


def distance(one: int, other: int, inputs: Array, numbers: Array) -> float:
    """How far two robots are from each other (m)."""
    states = TRAFFIC_PORT * int(numbers[CHANNELS])
    a, b = states + STATE_PORT * one, states + STATE_PORT * other
    return math.hypot(inputs[a] - inputs[b], inputs[a + 1] - inputs[b + 1])


def is_near(one: int, other: int, inputs: Array, numbers: Array) -> bool:
    """Whether a robot hears another's radio, be it to understand it or to be disturbed."""
    return bool(numbers[RANGE] == 0.0 or distance(one, other, inputs, numbers) <= numbers[RANGE])


def may_begin(station: int, slot: float, inputs: Array, state: Array, numbers: Array) -> bool:
    """Whether a station that waits begins to send in a slot."""
    protocol, row = numbers[PROTOCOL], station_row(station, numbers)
    if protocol == TDMA:
        return bool(slot % numbers[STATIONS] == station)
    if protocol == ALOHA:
        return bool(draw(state) < numbers[PROBABILITY] * 0.5 ** state[row + FAILED])
    if hears_another(station, slot, inputs, state, numbers):
        return False
    if protocol == CSMA and state[row + BACKOFF] > 0.0:
        state[row + BACKOFF] -= 1.0
        return False
    return True


def hears_another(station: int, slot: float, inputs: Array, state: Array, numbers: Array) -> bool:
    """Whether a station hears another one send: one that began earlier, or on a bus that wins the arbitration.

    Stations are asked in the order of their identifiers, so that on a bus the first of those that wait has it.
    """
    robot, bus = speaker_of(station, numbers), numbers[PROTOCOL] == PRIORITY
    for other in range(int(numbers[STATIONS])):
        row = station_row(other, numbers)
        if (
            state[row + SENDING] > 0.0
            and (bus or state[row + BEGUN] < slot)
            and is_near(robot, speaker_of(other, numbers), inputs, numbers)
        ):
            return True
    return False


def back_off(row: int, state: Array, numbers: Array) -> None:
    """Draw how many idle slots a station lets pass: from a window that is doubled after every failure."""
    if numbers[PROTOCOL] == CSMA:
        window = min(numbers[WINDOW] * 2.0 ** state[row + FAILED], numbers[WIDEST])
        state[row + BACKOFF] = math.floor(draw(state) * window)
