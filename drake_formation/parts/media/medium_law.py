"""What becomes of packets that share a medium: the update of its block, on plain arrays.

The functions are in the Python that numba compiles; :data:`SHARE` is the law. Nothing new is offered between two looks
of the channels, so that it is worked out at once, half-way, what becomes of all slots from one look to the next.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.parts.media import access

# isort: off
from drake_formation.parts.media.access import (
    AIRTIME, BEFORE, BEGUN, CARRIED, CHANNELS, COLLIDED, DECIDED, DROPPED, DURATION, ENDS, EXPONENT, FADES, FAILED,
    FIRST, HALF, LENGTH, LINK, LISTENER, MARGIN, NEXT, NUMBER, OFFERED, OWNER, PRIORITY, PROTOCOL, REPORT, REPORTS,
    RETRIES, SEEN, SENDING, SETTINGS, SLOT, SPEAKER, STATIONS, THROUGH, THROUGH_BEFORE, TRAFFIC_PORT, WAITING,
    back_off, distance, draw, hears_another, is_near, may_begin, speaker_of, station_row, turn_row,
)  # fmt: skip

# isort: on
from drake_formation.systems.random_stream import advance, next_uniform
from drake_formation.systems.sampled_law import SampledLaw

Array = NDArray[np.float64]

SLOT_ROUNDING = 1e-6
"""By how much a time divided by a slot may be off."""


def share_medium(time: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Work through the slots of half an interval before and after.

    Args:
        time: time (s).
        inputs: the traffic of every channel, whose first number is that of its newest packet; then the state of every
            robot (m, m/s).
        state: as the groups of :class:`drake_formation.parts.media.medium_block.Medium`; updated.
        numbers: the settings and tables that :mod:`drake_formation.parts.media.access` names.
    """
    take_offers(inputs, state, numbers)
    first = math.ceil((time - numbers[HALF]) / numbers[SLOT] - SLOT_ROUNDING)
    last = math.ceil((time + numbers[HALF]) / numbers[SLOT] - SLOT_ROUNDING)
    slot = max(state[NEXT], float(first))
    while slot < last:
        begin_frames(slot, inputs, state, numbers)
        slot = next_slot(slot, float(last), state, numbers)
        end_frames(slot, inputs, state, numbers)
    state[NEXT] = slot
    for channel in range(int(numbers[CHANNELS])):
        row = station_row(int(numbers[SETTINGS + LINK * channel + OWNER]), numbers)
        oldest = state[row + SENDING] if state[row + SENDING] > 0.0 else state[row + WAITING]
        state[REPORTS + REPORT * channel + DECIDED] = oldest - 1.0 if oldest > 0.0 else state[row + SEEN]


def take_offers(inputs: Array, state: Array, numbers: Array) -> None:
    """Let the newest packet of every channel wait; one that still waits is dropped, and it backs off in its place."""
    for channel in range(int(numbers[CHANNELS])):
        station = int(numbers[SETTINGS + LINK * channel + OWNER])
        row = station_row(station, numbers)
        first = int(numbers[turn_row(station, numbers) + FIRST])
        newest = inputs[TRAFFIC_PORT * first] - state[row + SEEN]
        if newest > 0.0:
            state[OFFERED] += newest
            state[DROPPED] += newest - 1.0 + (state[row + WAITING] > 0.0)
    for station in range(int(numbers[STATIONS])):
        row = station_row(station, numbers)
        newest = inputs[TRAFFIC_PORT * int(numbers[turn_row(station, numbers) + FIRST])]
        if newest > state[row + SEEN]:
            if state[row + SENDING] == 0.0 and state[row + WAITING] == 0.0:
                back_off(row, state, numbers)
            state[row + WAITING] = state[row + SEEN] = newest


def next_slot(slot: float, last: float, state: Array, numbers: Array) -> float:
    """The next slot in which anything may happen; on a bus nothing does before a frame has ended."""
    busy, ends = False, np.inf
    for station in range(int(numbers[STATIONS])):
        row = station_row(station, numbers)
        busy = busy or state[row + WAITING] > 0.0 or state[row + SENDING] > 0.0
        if state[row + SENDING] > 0.0:
            ends = min(ends, state[row + ENDS])
    if numbers[PROTOCOL] == PRIORITY and ends < np.inf:
        return ends
    return slot + 1.0 if busy else last


def begin_frames(slot: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Let those stations send that may; where two are heard at once, neither is understood."""
    some = False
    for station in range(int(numbers[STATIONS])):
        row, turn = station_row(station, numbers), turn_row(station, numbers)
        if state[row + WAITING] == 0.0 or state[row + SENDING] > 0.0:
            continue
        if may_begin(station, slot, inputs, state, numbers):
            state[row + SENDING], state[row + WAITING] = state[row + WAITING], 0.0
            state[row + BEGUN], state[row + ENDS] = slot, slot + numbers[turn + LENGTH]
            state[AIRTIME] += numbers[turn + DURATION]
            some = True
    if some:
        disturb(slot, inputs, state, numbers)


def disturb(slot: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Mark the channels that are disturbed by frames that have just begun, their own or another."""
    marks = station_row(int(numbers[STATIONS]), numbers)
    for channel in range(int(numbers[CHANNELS])):
        link = SETTINGS + LINK * channel
        station = int(numbers[link + OWNER])
        row = station_row(station, numbers)
        if state[row + SENDING] == 0.0:
            continue
        if state[row + BEGUN] == slot:
            state[marks + channel] = 0.0
        for other in range(int(numbers[STATIONS])):
            another = station_row(other, numbers)
            if other == station or state[another + SENDING] == 0.0:
                continue
            newly = state[row + BEGUN] == slot or state[another + BEGUN] == slot
            if newly and is_near(int(numbers[link + LISTENER]), speaker_of(other, numbers), inputs, numbers):
                state[marks + channel] = 1.0


def end_frames(slot: float, inputs: Array, state: Array, numbers: Array) -> None:
    """Say what became of the frames that have ended: carried, to be sent again, or dropped."""
    for station in range(int(numbers[STATIONS])):
        row = station_row(station, numbers)
        if state[row + SENDING] == 0.0 or state[row + ENDS] > slot:
            continue
        backs_off = state[row + FAILED] < numbers[RETRIES]
        again = backs_off and state[row + WAITING] == 0.0
        reached = hand_over(station, again, inputs, state, numbers)
        if again and not reached:
            state[row + WAITING] = state[row + SENDING]
        state[row + FAILED] = state[row + FAILED] + 1.0 if backs_off and not reached else 0.0
        state[row + SENDING] = 0.0
        if state[row + WAITING] > 0.0:
            back_off(row, state, numbers)


def hand_over(station: int, again: bool, inputs: Array, state: Array, numbers: Array) -> bool:
    """Hand a frame to those who hear it; whether all do. Where it is not sent again, it is lost for the others."""
    row, marks = station_row(station, numbers), station_row(int(numbers[STATIONS]), numbers)
    through = state[row + BEGUN] * numbers[SLOT] + numbers[turn_row(station, numbers) + DURATION]
    reached, collided = True, False
    for channel in range(int(numbers[CHANNELS])):
        if numbers[SETTINGS + LINK * channel + OWNER] != station:
            continue
        disturbed = state[marks + channel] > 0.0
        collided = collided or disturbed
        report = REPORTS + REPORT * channel
        if not disturbed and is_received(channel, inputs, state, numbers):
            state[report + BEFORE], state[report + THROUGH_BEFORE] = state[report + NUMBER], state[report + THROUGH]
            state[report + NUMBER], state[report + THROUGH] = state[row + SENDING], through
            state[CARRIED] += 1.0
        else:
            reached = False
            state[DROPPED] += 0.0 if again else 1.0
    state[COLLIDED] += 1.0 if collided else 0.0
    return reached


def is_received(channel: int, inputs: Array, state: Array, numbers: Array) -> bool:
    """Whether a frame that nobody disturbs is received: in range, and not in a deep fade.

    The mean power falls with the distance d as d^-n; by Rayleigh fading the power is distributed exponentially about
    it, so that it is above what is needed with probability exp(-needed/mean) (Goldsmith 2005, *Wireless
    Communications*, Eqs. 2.40 and 6.46).
    """
    link = SETTINGS + LINK * channel
    speaker, listener = int(numbers[link + SPEAKER]), int(numbers[link + LISTENER])
    if not is_near(speaker, listener, inputs, numbers):
        return False
    if numbers[FADES] == 0.0:
        return True
    apart = max(distance(speaker, listener, inputs, numbers), 1e-9)
    return draw(state) < math.exp(-(10.0 ** (-numbers[MARGIN] / 10.0)) * apart ** numbers[EXPONENT])


CONSTANTS: dict[str, Any] = {
    name: value
    for name, value in {**vars(access), "SLOT_ROUNDING": SLOT_ROUNDING}.items()
    if isinstance(value, int | float)
}
SHARE = SampledLaw(
    share_medium,
    *(advance, next_uniform, draw, station_row, turn_row, speaker_of, distance, is_near, hears_another, may_begin),
    *(back_off, take_offers, next_slot, disturb, begin_frames, is_received, hand_over, end_frames),
    constants=CONSTANTS,
)
"""The law."""
