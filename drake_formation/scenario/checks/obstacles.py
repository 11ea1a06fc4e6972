"""Shapes and motions of obstacles, one by one."""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from drake_formation.config.errors import Fault, Path, shown
from drake_formation.scenario import derive
from drake_formation.scenario.obstacles import Circle, Segment
from drake_formation.scenario.schema import Scenario

LEAST = 1e-6
"""Least length of an edge (m) and least time between waypoints (s)."""


def check(scenario: Scenario) -> Iterator[Fault]:
    """Everything about obstacles by themselves."""
    for index, obstacle in enumerate(scenario.avoidance.obstacles):
        path: Path = ("avoidance", "obstacles", index)
        if not isinstance(obstacle, Circle):
            yield from _shape(path, obstacle)
        yield from _motion(path, obstacle)


def _shape(path: Path, obstacle: Any) -> Iterator[Fault]:
    field = "ends" if isinstance(obstacle, Segment) else "vertices"
    vertices = derive.outline(obstacle)
    edges = np.roll(vertices, -1, axis=0) - vertices
    for index in np.flatnonzero(np.hypot(*edges.T) < LEAST).tolist():
        after = (index + 1) % len(vertices)
        message = "a segment's ends are in one place" if field == "ends" else "two corners in a row are in one place"
        yield Fault((*path, field, after), message, shown(vertices[after].tolist()), f"{LEAST:g} m apart or more")
        return
    if field == "vertices":
        yield from _polygon((*path, field), vertices)


def _polygon(path: Path, vertices: derive.Array) -> Iterator[Fault]:
    """A polygon's edges meet at its corners and nowhere else."""
    from shapely import Polygon  # slow to import, and most scenarios have no polygon
    from shapely.validation import explain_validity

    polygon = Polygon(vertices)
    if not polygon.is_valid:
        reason, _, place = explain_validity(polygon).partition("[")
        where = f" at [{place.rstrip(']').replace(' ', ', ')}]" if place else ""
        message = f"the polygon's edges cross or touch{where} ({reason.lower()})"
        yield Fault(path, message, shown(vertices.tolist()), "corners in their order around it")
    elif polygon.area < LEAST * polygon.length:
        yield Fault(path, "the polygon has no inside", shown(vertices.tolist()), "kind segment for a thin wall")


def _motion(path: Path, obstacle: Any) -> Iterator[Fault]:
    if obstacle.velocity is not None and obstacle.waypoints:
        yield Fault((*path, "waypoints"), "both velocity and waypoints are given", allowed="one of them")
    times = [obstacle.start, *(waypoint.time for waypoint in obstacle.waypoints)]
    for index, (before, time) in enumerate(pairwise(times)):
        if time < before + LEAST:
            what = "start" if index == 0 else f"waypoint {index}"
            message = f"no later than {what}, {before:g} s"
            yield Fault((*path, "waypoints", index, "time"), message, shown(time), f"more than {before:g} s")
