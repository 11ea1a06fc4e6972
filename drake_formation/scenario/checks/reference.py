"""The reference: whether it is in time, and whether a plan gets past what it knows."""

from collections.abc import Iterator

import numpy as np

from drake_formation.scenario import derive
from drake_formation.scenario import reference as references
from drake_formation.scenario.errors import Fault, Path, shown
from drake_formation.scenario.schema import PotentialFieldReference, Scenario, SetPointReference, WaypointsReference

SHORTEST, LONGEST = 1e-3, 1e6
"""Durations of a motion (s) between which the coefficients of its polynomials neither overflow nor vanish."""

NEAREST = 1e-6
"""Points nearer to each other than this share of the whole way are passed too fast for any curve."""

KEPT = 0.75
"""What a smoothed plan keeps of the clearance, at least."""

PATH: Path = ("transport", "reference")


def check(scenario: Scenario) -> Iterator[Fault]:
    """Everything about the reference of a scenario whose places are sound."""
    reference = scenario.transport.reference
    if isinstance(reference, SetPointReference):
        return
    late = list(_duration(scenario, reference.duration))
    yield from late
    if isinstance(reference, WaypointsReference):
        yield from _waypoints(scenario, reference)
    elif isinstance(reference, PotentialFieldReference):
        faults = [*_known(scenario, reference), *_reach(reference)] or list(_places(scenario, reference))
        yield from faults
        if not faults and not late:
            yield from _plan(scenario, reference)


def _duration(scenario: Scenario, given: float | None) -> Iterator[Fault]:
    path: Path = ("transport", "duration") if given is None else (*PATH, "duration")
    duration, transport = references.motion_duration(scenario), scenario.transport.duration
    if duration > transport:
        message = "the motion takes longer than the transport, so the goal is not reached in time"
        yield Fault(path, message, shown(duration), f"at most transport.duration, {transport:g} s")
    elif not SHORTEST <= duration <= LONGEST:
        message = "no duration of a motion"
        yield Fault(path, message, shown(duration), f"from {SHORTEST:g} to {LONGEST:g} s, or a set point as reference")


def _waypoints(scenario: Scenario, reference: WaypointsReference) -> Iterator[Fault]:
    places = references.waypoint_places(scenario, reference)
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    nearest = NEAREST * steps.sum()
    names = ["where the formation gathers", *(f"point {k + 1}" for k in range(len(reference.points))), "the goal"]
    for k in np.flatnonzero(steps <= nearest):
        # The fault stands at a point that the user wrote: the later of the two, or the last before the goal.
        entry = min(int(k), len(reference.points) - 1)
        yield Fault(
            (*PATH, "points", entry),
            f"{names[k]} and {names[k + 1]} are one place",
            shown(reference.points[entry]),
            f"points more than {nearest:.3g} m apart",
        )


def _known(scenario: Scenario, reference: PotentialFieldReference) -> Iterator[Fault]:
    """Obstacles one by one: such as there are, and each once."""
    count = len(scenario.avoidance.obstacles)
    numbers = () if reference.known == "all" else reference.known
    allowed = f"numbers of obstacles from 1 to {count}" if count else "none, there are no obstacles"
    for index, number in enumerate(numbers):
        path = (*PATH, "known", index)
        if not 1 <= number <= count:
            yield Fault(path, f"there is no obstacle {number}", shown(number), allowed)
        elif number in numbers[:index]:
            yield Fault(path, f"the same obstacle as entry {numbers.index(number)}", shown(number), "each once")


def _reach(reference: PotentialFieldReference) -> Iterator[Fault]:
    if reference.reach <= reference.clearance:
        allowed = f"more than transport.reference.clearance, {reference.clearance:g} m"
        yield Fault((*PATH, "reach"), "not beyond the clearance", shown(reference.reach), allowed)


def _places(scenario: Scenario, reference: PotentialFieldReference) -> Iterator[Fault]:
    """Start and goal of a plan: apart, and clear of what it knows."""
    from drake_formation.references.potential_field import clearances

    start, goal = derive.aggregation_centre(scenario), np.array(scenario.transport.goal)
    if np.linalg.norm(goal - start) <= NEAREST:
        message, allowed = "where the formation gathers already: nothing to plan", "another goal, or kind set_point"
        yield Fault(("transport", "goal"), message, shown(goal.tolist()), allowed)
    field, known = references.planning_field(scenario, reference), references.known_obstacles(scenario, reference)
    paths: tuple[tuple[Path, str, derive.Array], ...] = (
        (("robots", "start"), "the formation gathers", start),
        (("transport", "goal"), "the formation at the goal is", goal),
    )
    for path, what, centre in paths:
        for index in np.flatnonzero(clearances(centre, field.discs) <= reference.clearance):
            apart = reference.clearance + field.discs[index, 2]
            message = f"{what} nearer to obstacle {known[index] + 1} than the plan's clearance"
            allowed = f"a formation centre more than {apart:.4g} m from it, or a smaller transport.reference.clearance"
            yield Fault(path, message, shown(centre.tolist()), allowed)


def _plan(scenario: Scenario, reference: PotentialFieldReference) -> Iterator[Fault]:
    from drake_formation.references.potential_field import StuckError, closest

    ways_out = "a smaller clearance, fewer known obstacles, or points of your own (kind waypoints)"
    field = references.planning_field(scenario, reference)
    try:
        trajectory = references.planned(scenario, field)
    except StuckError as error:
        place = shown([round(x, 3) for x in error.place.tolist()])
        message = f"the plan gets stuck between known obstacles at {place}, in a local minimum of the field"
        yield Fault(PATH, message, allowed=ways_out)
        return
    places = trajectory.vector_values(np.linspace(0.0, trajectory.end_time(), 1000)).T
    kept = closest(places, field.discs).min(initial=np.inf)
    if kept < KEPT * reference.clearance:
        message = f"the plan comes within {kept:.3g} m of a known obstacle when smoothed"
        yield Fault((*PATH, "clearance"), message, shown(reference.clearance), ways_out)
