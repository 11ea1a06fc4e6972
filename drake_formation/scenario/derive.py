"""What follows from a scenario's fields: slots, starting positions and graphs; for its checks and for resolving it."""

import functools
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.config.each import Owners
from drake_formation.formation import graphs, shapes
from drake_formation.formation.formation import SPRINGS
from drake_formation.formation.links import Channels, Edges
from drake_formation.formation.obstacles import Obstacle, Obstacles
from drake_formation.scenario.obstacles import Circle, Segment
from drake_formation.scenario.schema import (
    FormationStart,
    Grid,
    Line,
    Polygon,
    RandomStart,
    Scenario,
    Shape,
    Slots,
)

Array = NDArray[np.float64]

NEVER = 1e12
"""When a motion without an end ends (s), later than any run."""


def robot_count(shape: Shape) -> int:
    """Number of robots N of a shape."""
    if isinstance(shape, Slots):
        return len(shape.slots)
    return shape.rows * shape.columns if isinstance(shape, Grid) else shape.robots


def slots(scenario: Scenario) -> Array:
    """Slots h_i relative to the formation centre (m), shape (N, 2)."""
    return slots_of(scenario.formation)


def slots_of(shape: Shape) -> Array:
    """Slots of a shape (m), shape (N, 2)."""
    if isinstance(shape, Slots):
        return np.array(shape.slots, dtype=float)
    if isinstance(shape, Line):
        return shapes.line(shape.robots, shape.side, shape.heading)
    if isinstance(shape, Grid):
        return shapes.grid(shape.rows, shape.columns, shape.side)
    return shapes.polygon(shape.robots, polygon_side(shape), shape.heading)


def polygon_side(shape: Polygon) -> float:
    """Side of a polygon (m), given directly or by its width across flats.

    Raises:
        ValueError: neither or both are given, or a width for an odd number of robots.
    """
    if shape.side is not None and shape.width is None:
        return shape.side
    if shape.width is not None and shape.side is None:
        return shapes.side_from_width(shape.robots, shape.width)
    raise ValueError("give either side or width")


def starts(scenario: Scenario) -> Array:
    """Starting positions (m, world frame), shape (N, 2)."""
    start = scenario.robots.start
    if isinstance(start, FormationStart):
        return np.asarray(start.centre) + slots(scenario)
    if isinstance(start, RandomStart):
        box = start.random
        count = robot_count(scenario.formation)
        offsets: Array = np.random.default_rng(box.seed).uniform(-box.spread, box.spread, (count, 2))
        offsets -= offsets.mean(axis=0)
        return np.asarray(box.about) + offsets
    return np.array(start, dtype=float)


def aggregation_centre(scenario: Scenario) -> Array:
    """Where the formation gathers: the mean of the starting positions (m), shape (2,)."""
    centre: Array = starts(scenario).mean(axis=0)
    return centre


@functools.lru_cache(maxsize=256)
def graph(topology: str | tuple[tuple[int, int], ...], robots: int) -> nx.Graph:
    """A scenario's graph (robots numbered from 1) as a graph on 0 … N-1, which is shared and cannot be changed."""
    if isinstance(topology, str):
        return nx.freeze(graphs.graph(topology, robots))
    return nx.freeze(graphs.graph([(i - 1, j - 1) for i, j in topology], robots))


@functools.lru_cache(maxsize=64)
def _edges(graph: nx.Graph) -> Edges:
    return Edges.of(graph)


def spring_edges(scenario: Scenario) -> Edges:
    """The edges of the physical graph; none where the object is a body of its own."""
    if scenario.object.kind != SPRINGS:
        return _edges(graph((), robot_count(scenario.formation)))
    return _edges(spring_graph(scenario))


def spring_graph(scenario: Scenario) -> nx.Graph:
    """The physical graph: robots coupled by the object."""
    return graph(scenario.springs.graph, robot_count(scenario.formation))


def channels(scenario: Scenario) -> Channels:
    """The channels with their weights: those of a name or an edge go both ways."""
    topology, robots = scenario.consensus.graph, robot_count(scenario.formation)
    if isinstance(topology, str):
        edges = graphs.edges(graph(topology, robots))
        return Channels.of(robots, [(i, j, 1.0) for pair in edges for i, j in (pair, pair[::-1])])
    directed: list[tuple[int, int, float]] = []
    for link in topology:
        if isinstance(link, tuple):
            i, j = link[0] - 1, link[1] - 1
            directed += [(i, j, 1.0), (j, i, 1.0)]
        else:
            directed.append((link.listener - 1, link.speaker - 1, link.weight))
    return Channels.of(robots, directed)


def footprints(scenario: Scenario) -> Array:
    """Radius of every robot's footprint (m), shape (N,)."""
    written, owners = scenario.robots.radius, Owners.robots(robot_count(scenario.formation))
    radii = [owners.value(written, i, False, 0.0) for i in range(len(owners.names))]
    return np.array(radii, dtype=float)


def obstacles(scenario: Scenario) -> Obstacles:
    """The obstacles, polygons counter-clockwise."""
    return Obstacles(tuple(map(_obstacle, scenario.avoidance.obstacles)))


def _obstacle(written: Any) -> Obstacle:
    vertices = outline(written)
    if len(vertices) > 2:
        ahead = np.roll(vertices, -1, axis=0)
        if (vertices[:, 0] * ahead[:, 1] - vertices[:, 1] * ahead[:, 0]).sum() < 0:
            vertices = np.concatenate([vertices[:1], vertices[:0:-1]])  # waypoints are of the first corner
    return Obstacle(vertices, written.radius, written.known, _motion(written))


def outline(written: Any) -> Array:
    """The vertices of an obstacle in the order in which they are written (m), shape (vertices, 2)."""
    if isinstance(written, Circle):
        return np.array([written.position], dtype=float)
    return np.array(written.ends if isinstance(written, Segment) else written.vertices, dtype=float)


def _motion(written: Any) -> Array:
    """When each piece of an obstacle's motion begins and ends (s) and its velocity (m/s), shape (pieces, 4)."""
    if written.velocity is not None:
        return np.array([[written.start, NEVER, *written.velocity]])
    pieces = []
    begin, place = written.start, outline(written)[0]
    for waypoint in written.waypoints:
        next_place = np.array(waypoint.position, dtype=float)
        pieces.append([begin, waypoint.time, *((next_place - place) / (waypoint.time - begin))])
        begin, place = waypoint.time, next_place
    return np.array(pieces, dtype=float).reshape(-1, 4)
