"""Which communication graphs are tried, and with which robot where in them."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import permutations

import networkx as nx
import numpy as np

from drake_formation.analysis.topology.enumeration import MOST_CLASSED, connected_shapes
from drake_formation.analysis.topology.rigid_shapes import distinct, minimally_rigid_shapes
from drake_formation.formation import graphs

ROBOTS = range(3, 9)
"""Numbers of robots of the study."""

PLACEMENTS = {6: 4, 7: 1, 8: 1}
"""Ways, at most, in which robots are put on the nodes of a graph, drawn from a seed; all of them where not named."""

SAMPLED = 10
"""Graphs for each number of edges where not all can be tried, beside the minimally rigid ones; from a seed."""


@dataclass(frozen=True)
class Placed:
    """A communication graph between numbered robots.

    Attributes:
        shape: number of its class of isomorphic graphs, among those of as many robots.
        graph: who talks with whom, robots from 0.
    """

    shape: int
    graph: nx.Graph


def placed_graphs(robots: int) -> list[Placed]:
    """The graphs that are tried for a number of robots, the same ones each time."""
    return [Placed(k, graph) for k, shape in enumerate(shapes(robots)) for graph in _placements(shape, robots)]


@cache
def shapes(robots: int) -> tuple[nx.Graph, ...]:
    """No channels at all, then connected graphs: all of them up to 7 robots; beyond, those that ``covered`` says."""
    if robots <= MOST_CLASSED:
        connected = [graph for alike in connected_shapes(robots).values() for graph in alike]
    else:
        connected = distinct([*_minimally_rigid(robots), *_known(robots), *_sampled(robots)])
    return nx.empty_graph(robots), *connected


def covered(robots: int) -> str:
    """What is tried of the connected graphs between so many robots, in words."""
    count = len(shapes(robots)) - 1
    if robots <= MOST_CLASSED:
        shape = f"all {count} connected graphs"
    else:
        rigid = len(_minimally_rigid(robots))
        shape = (
            f"all {rigid} minimally rigid graphs, {SAMPLED} drawn at random for each number of edges, path, star, "
            f"cycle, the complete graph and that of one robot less with one hanging on: {count}"
        )
    placed = PLACEMENTS.get(robots)
    return f"{shape}, with robots placed in {f'{placed} random' if placed else 'all'} way{'s' * (placed != 1)}"


@cache
def _minimally_rigid(robots: int) -> tuple[nx.Graph, ...]:
    return tuple(minimally_rigid_shapes(robots))


def _known(robots: int) -> list[nx.Graph]:
    named = [graphs.graph(name, robots) for name in ("path", "star", "cycle", "complete")]
    return [*named, nx.lollipop_graph(robots - 1, 1)]


def _sampled(robots: int) -> Iterator[nx.Graph]:
    rng = np.random.default_rng(robots)
    for edges in range(robots - 1, robots * (robots - 1) // 2):
        found = 0
        while found < SAMPLED:
            graph = nx.gnm_random_graph(robots, edges, seed=int(rng.integers(2**32)))
            if nx.is_connected(graph):
                found += 1
                yield graph


def _placements(shape: nx.Graph, robots: int) -> list[nx.Graph]:
    """A graph with robots put on its nodes in different ways, as many as are tried."""
    found: dict[tuple[graphs.Edge, ...], nx.Graph] = {}
    for way in _ways(robots):
        graph = graphs.graph([(way[i], way[j]) for i, j in shape.edges], robots)
        found.setdefault(tuple(graphs.edges(graph)), graph)
    return list(found.values())[: PLACEMENTS.get(robots)]


def _ways(robots: int) -> Iterator[tuple[int, ...]]:
    """Orders of the robots: all of them, or more than enough drawn from a seed."""
    if robots not in PLACEMENTS:
        yield from permutations(range(robots))
        return
    rng = np.random.default_rng(robots)
    for _ in range(4 * PLACEMENTS[robots]):
        yield tuple(rng.permutation(robots).tolist())
