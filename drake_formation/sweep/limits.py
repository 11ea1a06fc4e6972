"""How large a sweep may be. What is larger is a slip, not a plan, and is refused before anything is allocated."""

import math
from collections.abc import Iterator, Sequence
from typing import Any

from drake_formation.config.errors import Path, shown
from drake_formation.scenario import Fault, Scenario, resolve
from drake_formation.sweep.axes import extent
from drake_formation.sweep.schema import AxisModel, Trajectories

MOST_POINTS = 10_000_000
"""Of a sweep; also the most values of all fields along one axis, which are in memory together."""

MOST_SAMPLES = 10_000_000
"""Numbers in the time series of one run, which are in memory together: 80 MB."""

MOST_KEPT = 100_000_000_000
"""Numbers in the time series of all runs: 800 GB."""

MOST_INTEGER = 10**308
"""Larger ones are no floating-point numbers, and Python itself refuses to write the longest of them."""


def value_faults(data: Any, path: Path = ()) -> Iterator[Fault]:
    """Integers and texts that neither a dataset nor a database could hold, anywhere in plain data."""
    match data:
        case dict():
            for key, value in data.items():
                yield from value_faults(key, path)
                yield from value_faults(value, (*path, key))
        case list() | tuple():
            for position, value in enumerate(data):
                yield from value_faults(value, (*path, position))
        case int() if abs(data) > MOST_INTEGER:
            yield Fault(path, "out of range", shown(data), "integers up to 1e308")
        case str() if "\0" in data or any("\ud800" <= character <= "\udfff" for character in data):
            yield Fault(path, "not text", shown(data), "text without null characters and halves of characters")


def size_faults(axes: Sequence[AxisModel]) -> Iterator[Fault]:
    """Axes that are too long, or else their product."""
    allowed = f"at most {MOST_POINTS}"
    sizes = [extent(axis) for axis in axes]
    long = False
    for k, (positions, fields, source) in enumerate(sizes):
        if positions * max(fields, 1) > MOST_POINTS:
            long = True
            of = f" of {fields} fields" if fields > 1 else ""
            yield Fault(("axes", k, source), f"{shown(positions)} positions{of}", allowed=allowed)
    points = math.prod(positions for positions, _, _ in sizes)
    if not long and points > MOST_POINTS:
        yield Fault(("axes",), f"{shown(points)} points", allowed=allowed)


def series_faults(trajectories: Trajectories | None, scenario: Scenario, points: int) -> Iterator[Fault]:
    """Time series of too many numbers.

    Args:
        trajectories: what is kept of each run.
        scenario: one of the runs.
        points: how many runs there are.
    """
    if not trajectories:
        return
    formation = resolve(scenario)
    duration, robots = formation.end - formation.begin, formation.robots
    numbers = (duration / trajectories.every + 1) * 2 * robots * len(trajectories.variables)
    place = ("trajectories", "every")
    if numbers > MOST_SAMPLES:
        yield Fault(place, f"{numbers:.3g} numbers to keep of one run", allowed=f"at most {MOST_SAMPLES}")
    elif numbers * points > MOST_KEPT:
        message = f"{numbers * points:.3g} numbers to keep of {points} runs"
        yield Fault(place, message, allowed=f"at most {MOST_KEPT:.3g}")
