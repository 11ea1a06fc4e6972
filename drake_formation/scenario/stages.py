"""Failures of robots as stages of a run: what is so of every robot from a time on."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from drake_formation.formation.stages import Stage
from drake_formation.scenario import derive
from drake_formation.scenario.failures import DROPS, FREEZES, STOPS, Failure
from drake_formation.scenario.schema import Polygon, Scenario, Shape

Array = NDArray[np.float64]
FOREVER = float("inf")


def stages(scenario: Scenario) -> tuple[Stage, ...]:
    """The stages of a run, the first from its beginning; none where no robot fails.

    Args:
        scenario: its failures are sound.
    """
    if not scenario.failures:
        return ()
    begin = scenario.simulator.start_time
    times = {time for failure in scenario.failures for span in (out(failure), noticed(failure)) for time in span}
    later = sorted(time for time in times if begin < time < FOREVER)
    return tuple(_stage(scenario, time) for time in (-FOREVER, *later))


def out(failure: Failure) -> tuple[float, float]:
    """When a robot is out of order: from, and to (s)."""
    return failure.time, FOREVER if failure.repaired_at is None else failure.repaired_at


def noticed(failure: Failure) -> tuple[float, float]:
    """When the others do something about it: from, and to (s)."""
    if failure.response == "carry_on":
        return FOREVER, FOREVER
    begin, end = out(failure)
    return begin + failure.notice_after, end + failure.notice_after


def _stage(scenario: Scenario, time: float) -> Stage:
    robots = derive.robot_count(scenario.formation)
    now = max(time, scenario.simulator.start_time)
    drive, held, heeded = np.ones(robots), np.ones(robots), np.ones(robots)
    braking = np.zeros(robots)
    lost = set()
    for failure in scenario.failures:
        robot = failure.robot - 1
        if _within(now, out(failure)):
            drive[robot] *= failure.kind not in (STOPS, FREEZES)
            held[robot] *= failure.kind != DROPS
            if failure.kind == FREEZES:
                braking[robot] = 1.0 / failure.brake_time
        if _within(now, noticed(failure)):
            heeded[robot] = 0.0
            if failure.response == "re_form":
                lost.add(robot)
    return Stage(time, drive, braking, held, heeded, smaller_slots(scenario, lost))


def _within(time: float, span: tuple[float, float]) -> bool:
    return span[0] <= time < span[1]


def smaller_slots(scenario: Scenario, lost: Iterable[int]) -> Array:
    """Slots of the same shape without some robots, about the same centre; those keep the slots they had.

    The others take the new slots so that the sum of their ways from the slots as planned is the least.

    Args:
        scenario: its shape is a line or a polygon where robots are lost.
        lost: robots, from 0, fewer than there are.
    """
    slots = derive.slots(scenario).copy()
    left = np.array(sorted(set(range(len(slots))) - set(lost)))
    if len(left) == len(slots):
        return slots
    new = _shrunk(scenario.formation, len(left))
    ways = np.linalg.norm(slots[left, None] - new, axis=-1)
    who, where = linear_sum_assignment(ways)
    slots[left[who]] = new[where]
    return slots


def _shrunk(shape: Shape, robots: int) -> Array:
    """Slots of a line with the same distance between neighbours, or of a polygon with the same side (m)."""
    if robots == 1:
        return np.zeros((1, 2))
    changes: dict[str, object] = {"robots": robots}
    if isinstance(shape, Polygon):
        changes |= {"side": derive.polygon_side(shape), "width": None}
    return derive.slots_of(shape.model_copy(update=changes))
