"""What follows from a scenario's fields: slots, starting positions and graphs; for its checks and for resolving it."""

import functools

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.formation import graphs, shapes
from drake_formation.formation.formation import SPRINGS
from drake_formation.formation.links import Channels, Edges
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


def obstacles(scenario: Scenario) -> Array:
    """Centre and radius of each obstacle (m), shape (obstacles, 3)."""
    rows = [[*obstacle.position, obstacle.radius] for obstacle in scenario.avoidance.obstacles]
    return np.array(rows, dtype=float).reshape(-1, 3)
