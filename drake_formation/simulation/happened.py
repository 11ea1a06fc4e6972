"""Finding the events of a run: in its series, and in what was known before it."""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from drake_formation.scenario import resolve
from drake_formation.scenario.failures import DROPS, FREEZES, STOPS
from drake_formation.scenario.stages import noticed, out
from drake_formation.simulation.collisions import collisions
from drake_formation.simulation.events import HAND_OFF, Event
from drake_formation.simulation.series import Series

Finder = Callable[[Series], Iterator[Event]]
"""What finds the events of one kind in a run."""

FAILED = {STOPS: "stops actuating", FREEZES: "freezes", DROPS: "drops its load"}
RESPONDED = {
    "drop_neighbour": "is dropped by its neighbours",
    "re_form": "is dropped by its neighbours, which re-form without it",
}
"""What is said of kinds of failures, and of responses."""


def hand_offs(series: Series) -> Iterator[Event]:
    """The hand-off, at the centre of the robots, where a run got there and began before it."""
    carried = np.flatnonzero(series["phase"] == 1)
    if not len(carried) or carried[0] == 0:
        return
    place = series["position"][carried[0]].mean(axis=0)
    robots = tuple(range(1, len(series["slot"]) + 1))
    yield Event(
        HAND_OFF, float(series["time"][carried[0]]), _point(place), robots, "the object is placed on the robots"
    )


def breaks(series: Series) -> Iterator[Event]:
    """Springs that broke, each in its middle, and grips, each where its robot was."""
    formation = resolve(series.scenario)
    for k, time, position in _broken(series, "broken_at"):
        i, j = formation.springs.pairs[k].tolist()
        rest, length = formation.rest_lengths[k], float(np.linalg.norm(position[i] - position[j]))
        sentence = f"the spring between robots {i + 1} and {j + 1} breaks, {length:.4g} m long and at rest {rest:.4g} m"
        yield Event("break", time, _point((position[i] + position[j]) / 2), (i + 1, j + 1), sentence)
    for robot, time, position in _broken(series, "grip_broken_at"):
        yield Event("break", time, _point(position[robot]), (robot + 1,), f"the grip of robot {robot + 1} breaks")


def failures(series: Series) -> Iterator[Event]:
    """Robots that fail and are repaired, each where it was; and the response of the others, in their centre."""
    scenario, times = series.scenario, series["time"]
    for failure in scenario.failures:
        robot = failure.robot
        begin, end = out(failure)
        since, _ = noticed(failure)
        told = [
            ("failure", begin, FAILED[failure.kind]),
            ("repair", end, "is repaired"),
            ("response", since, RESPONDED.get(failure.response, "")),
        ]
        for kind, time, words in told:
            if times[0] <= time < times[-1]:
                position = series["position"][np.searchsorted(times, time)]
                others = np.delete(position, robot - 1, axis=0).mean(axis=0) if len(position) > 1 else position[0]
                place = _point(others if kind == "response" else position[robot - 1])
                yield Event(kind, float(time), place, (robot,), f"robot {robot} {words}")


def _broken(series: Series, name: str) -> Iterator[tuple[int, float, NDArray[np.float64]]]:
    """Which springs or grips broke, when (s), and where the robots were then (m)."""
    times = series.get(name, np.zeros(0))
    for k in np.flatnonzero(np.isfinite(times)):
        yield int(k), float(times[k]), series["position"][np.searchsorted(series["time"], times[k])]


def contacts(series: Series) -> Iterator[Event]:
    """Footprints that touch an obstacle or each other."""
    with np.errstate(over="ignore", invalid="ignore"):  # a run that diverged may end in numbers whose squares overflow
        yield from collisions(series)


FINDERS: tuple[Finder, ...] = (hand_offs, breaks, failures, contacts)
"""All there are; each looks for one kind."""


def found_events(series: Series) -> tuple[Event, ...]:
    """Everything that happened in a run, in order of time.

    Args:
        series: what came out of it.
    """
    return tuple(sorted((event for finder in FINDERS for event in finder(series)), key=lambda event: event.time))


def _point(place: NDArray[np.float64]) -> tuple[float, float]:
    return float(place[0]), float(place[1])
