"""Slots, starting positions, obstacles and goal: where the robots are."""

from collections.abc import Iterator

import numpy as np

from drake_formation.config.errors import Fault, Path, shown
from drake_formation.scenario import derive
from drake_formation.scenario.schema import MOST_ROBOTS, FormationStart, Grid, Polygon, Scenario, Slots

_SAME_PLACE = 1e-9
"""Robots closer than this (m) stand on one spot; the direction of a spring between them is undefined."""


def size(scenario: Scenario) -> Iterator[Fault]:
    """The number of robots."""
    count = derive.robot_count(scenario.formation)
    if count > MOST_ROBOTS:
        path: Path = ("formation", "rows") if isinstance(scenario.formation, Grid) else ("formation",)
        yield Fault(path, f"{count} robots are too many", allowed=f"at most {MOST_ROBOTS} robots")


def check(scenario: Scenario) -> Iterator[Fault]:
    """Everything about places."""
    sizes = list(_polygon(scenario.formation)) if isinstance(scenario.formation, Polygon) else []
    counts = list(_start_count(scenario))
    yield from sizes
    yield from counts
    if not sizes:
        yield from _slots(scenario)
        yield from _goal(scenario)
    if not (sizes and isinstance(scenario.robots.start, FormationStart)) and not counts:
        yield from _starts(scenario)
    if not sizes and not counts:
        yield from _hand_off(scenario)


def _polygon(shape: Polygon) -> Iterator[Fault]:
    if (shape.side is None) == (shape.width is None):
        message = "neither side nor width is given" if shape.side is None else "both side and width are given"
        yield Fault(("formation",), message, allowed="side or width (m)")
    elif shape.width is not None and (shape.robots % 2 or shape.robots < 4):
        message = f"a polygon of {shape.robots} corners has no two parallel sides to measure a width across"
        yield Fault(("formation", "width"), message, shown(shape.width), "side, or width for 4, 6, 8 … robots")


def _start_count(scenario: Scenario) -> Iterator[Fault]:
    start, count = scenario.robots.start, derive.robot_count(scenario.formation)
    if isinstance(start, tuple) and len(start) != count:
        message = f"{len(start)} starting positions for {count} robots"
        yield Fault(("robots", "start"), message, shown(start), f"{count} positions [x, y] (m), one a robot")


def _slots(scenario: Scenario) -> Iterator[Fault]:
    shape, slots = scenario.formation, derive.slots(scenario)
    for first, second in _coincident(slots):
        path: Path = ("formation", "slots", second) if isinstance(shape, Slots) else ("formation",)
        message = f"robots {first + 1} and {second + 1} have the same slot"
        yield Fault(path, message, shown(slots[second].tolist()), f"slots more than {_SAME_PLACE:g} m apart")


def _starts(scenario: Scenario) -> Iterator[Fault]:
    start, positions = scenario.robots.start, derive.starts(scenario)
    path: Path = ("robots", "start")
    # In formation robots coincide where their slots do, which is told already.
    for first, second in [] if isinstance(start, FormationStart) else _coincident(positions):
        yield Fault(
            (*path, second) if isinstance(start, tuple) else path,
            f"robots {first + 1} and {second + 1} start on one spot",
            shown(positions[second].tolist()),
            f"starting positions more than {_SAME_PLACE:g} m apart",
        )
    for robot, obstacle in _inside(scenario, positions):
        yield Fault(
            (*path, robot) if isinstance(start, tuple) else path,
            f"robot {robot + 1} starts inside obstacle {obstacle + 1}",
            shown(positions[robot].tolist()),
            _clear_of(scenario, obstacle),
        )


def _hand_off(scenario: Scenario) -> Iterator[Fault]:
    """Obstacles act from the hand-off on, when the robots have gathered about the mean of their starts."""
    if scenario.aggregation.duration == 0:
        return
    positions = derive.aggregation_centre(scenario) + derive.slots(scenario)
    for robot, obstacle in _inside(scenario, positions):
        message = f"the formation gathers about the mean start with robot {robot + 1} inside obstacle {obstacle + 1}"
        place, allowed = shown(positions[robot].tolist()), _clear_of(scenario, obstacle)
        yield Fault(("robots", "start"), message, place, allowed)


def _goal(scenario: Scenario) -> Iterator[Fault]:
    positions = np.asarray(scenario.transport.goal) + derive.slots(scenario)
    for robot, obstacle in _inside(scenario, positions):
        message = f"robot {robot + 1}'s slot at the goal is inside obstacle {obstacle + 1}"
        yield Fault(("transport", "goal"), message, shown(positions[robot].tolist()), _clear_of(scenario, obstacle))


def _coincident(positions: derive.Array) -> list[tuple[int, int]]:
    """Each robot that stands where one before it stands, with the first such one."""
    apart = np.linalg.norm(positions[:, None] - positions[None], axis=2)
    same = np.triu(apart < _SAME_PLACE, k=1)
    return [(int(same[:, robot].argmax()), int(robot)) for robot in np.flatnonzero(same.any(axis=0))]


def _inside(scenario: Scenario, positions: derive.Array) -> list[tuple[int, int]]:
    """Robots and the obstacles that they are in or on."""
    return [
        (int(robot), index)
        for index, obstacle in enumerate(scenario.avoidance.obstacles)
        for robot in np.flatnonzero(np.linalg.norm(positions - obstacle.position, axis=1) <= obstacle.radius)
    ]


def _clear_of(scenario: Scenario, index: int) -> str:
    obstacle = scenario.avoidance.obstacles[index]
    return f"more than {obstacle.radius:g} m from {shown(obstacle.position)}"
