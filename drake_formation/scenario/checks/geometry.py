"""Slots, starting positions, obstacles and goal: where the robots are."""

from collections.abc import Iterator

import numpy as np

from drake_formation.config.each import Owners
from drake_formation.config.errors import Fault, Path, shown
from drake_formation.scenario import derive
from drake_formation.scenario.schema import MOST_ROBOTS, FormationStart, Grid, Polygon, Scenario, Slots

_SAME_PLACE = 1e-9
"""Robots closer than this (m) stand on one spot; the direction of a spring between them is undefined."""


def size(scenario: Scenario) -> Iterator[Fault]:
    """The number of robots, and of their radii."""
    count = derive.robot_count(scenario.formation)
    if count > MOST_ROBOTS:
        path: Path = ("formation", "rows") if isinstance(scenario.formation, Grid) else ("formation",)
        yield Fault(path, f"{count} robots are too many", allowed=f"at most {MOST_ROBOTS} robots")
    else:
        owners = Owners.robots(count)
        yield from owners.faults(("robots", "radius"), scenario.robots.radius, listed=False, required=False)


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
    for first, second in _touching(slots, derive.footprints(scenario)):
        message = f"robots {first + 1} and {second + 1} touch in their slots"
        yield Fault(
            ("robots", "radius"), message, shown(scenario.robots.radius), "smaller radii, or slots farther apart"
        )


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
    for first, second in [] if isinstance(start, FormationStart) else _touching(positions, derive.footprints(scenario)):
        message = f"robots {first + 1} and {second + 1} touch where they start"
        yield Fault(("robots", "radius"), message, shown(scenario.robots.radius), "smaller radii, or other starts")
    for robot, obstacle in _inside(scenario, positions, scenario.simulator.start_time):
        yield Fault(
            (*path, robot) if isinstance(start, tuple) else path,
            f"robot {robot + 1} starts inside obstacle {obstacle + 1}",
            shown(positions[robot].tolist()),
            _clear_of(scenario, obstacle, robot),
        )


def _hand_off(scenario: Scenario) -> Iterator[Fault]:
    """Obstacles act from the hand-off on, when the robots have gathered about the mean of their starts."""
    if scenario.aggregation.duration == 0:
        return
    positions = derive.aggregation_centre(scenario) + derive.slots(scenario)
    for robot, obstacle in _inside(scenario, positions, scenario.simulator.start_time + scenario.aggregation.duration):
        message = f"the formation gathers about the mean start with robot {robot + 1} inside obstacle {obstacle + 1}"
        place, allowed = shown(positions[robot].tolist()), _clear_of(scenario, obstacle, robot)
        yield Fault(("robots", "start"), message, place, allowed)


def _goal(scenario: Scenario) -> Iterator[Fault]:
    positions = np.asarray(scenario.transport.goal) + derive.slots(scenario)
    end = scenario.simulator.start_time + scenario.aggregation.duration + scenario.transport.duration
    for robot, obstacle in _inside(scenario, positions, end):
        message = f"robot {robot + 1}'s slot at the goal is inside obstacle {obstacle + 1}"
        allowed = _clear_of(scenario, obstacle, robot)
        yield Fault(("transport", "goal"), message, shown(positions[robot].tolist()), allowed)


def _coincident(positions: derive.Array) -> list[tuple[int, int]]:
    """Each robot that stands where one before it stands, with the first such one."""
    apart = np.linalg.norm(positions[:, None] - positions[None], axis=2)
    same = np.triu(apart < _SAME_PLACE, k=1)
    return [(int(same[:, robot].argmax()), int(robot)) for robot in np.flatnonzero(same.any(axis=0))]


def _touching(positions: derive.Array, radii: derive.Array) -> list[tuple[int, int]]:
    """Pairs of robots whose footprints meet, though they do not stand in one place."""
    if not radii.any():
        return []
    apart = np.linalg.norm(positions[:, None] - positions[None], axis=2)
    touching = np.triu((apart <= radii[:, None] + radii) & (apart >= _SAME_PLACE), k=1)
    return [(int(first), int(second)) for first, second in np.argwhere(touching)]


def _inside(scenario: Scenario, positions: derive.Array, time: float) -> list[tuple[int, int]]:
    """Robots and the obstacles that they are in or on at a time (s), with what their footprints cover."""
    clearance = derive.obstacles(scenario).clearance(positions, time) - derive.footprints(scenario)[:, None]
    return [(int(robot), int(obstacle)) for obstacle, robot in np.argwhere(clearance.T <= 0)]


def _clear_of(scenario: Scenario, index: int, robot: int) -> str:
    obstacle = scenario.avoidance.obstacles[index]
    distance = obstacle.radius + derive.footprints(scenario)[robot]
    place = derive.outline(obstacle).tolist()
    moving = "" if obstacle.velocity is None and not obstacle.waypoints else ", which moves"
    return f"more than {distance:g} m from {shown(place[0] if len(place) == 1 else place)}{moving}"
