"""All connected graphs between a few robots, each once."""

from itertools import combinations

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.topology.reduced_graphs import MOST_RENUMBERED, Renumbering, interchangeable, renumberings

MOST_CLASSED = 7
"""Robots up to which networkx knows all graphs (Read and Wilson, An Atlas of Graphs, 1998)."""

Catalogue = dict[int, list[nx.Graph]]
"""Graphs by their number of edges."""


def catalogue(complete: LinearFormation, *, of_every_robot: bool) -> tuple[Catalogue, str] | None:
    """Connected graphs of which every other one is a copy, as far as a measure can tell.

    Args:
        complete: the formation on the complete graph.
        of_every_robot: whether the measure treats all robots alike.

    Returns:
        The graphs, and what they are in words; None for too many robots.
    """
    robots = complete.robots
    if of_every_robot and robots <= MOST_CLASSED and interchangeable(complete):
        return connected_shapes(robots), "all {} connected graphs up to isomorphism"
    if robots > MOST_RENUMBERED:
        return None
    group = renumberings(complete) if of_every_robot else [tuple(range(robots))]
    symmetry = f" up to the formation's {len(group)} symmetries" if len(group) > 1 else ""
    return connected_graphs(robots, group), "all {} connected graphs" + symmetry


def connected_shapes(robots: int) -> Catalogue:
    """All connected graphs up to isomorphism: 1, 2, 6, 21, 112, 853 for 2 … 7 robots."""
    from networkx.generators.atlas import graph_atlas_g

    found: Catalogue = {}
    for graph in graph_atlas_g():
        if graph.number_of_nodes() == robots and nx.is_connected(graph):
            found.setdefault(graph.number_of_edges(), []).append(graph)
    return dict(sorted(found.items()))


def connected_graphs(robots: int, group: list[Renumbering]) -> Catalogue:
    """All connected graphs on numbered robots, one of each orbit of a group of renumberings."""
    pairs = list(combinations(range(robots), 2))
    index = {pair: k for k, pair in enumerate(pairs)}
    moved = [[index[min(way[i], way[j]), max(way[i], way[j])] for i, j in pairs] for way in group]
    found: Catalogue = {}
    for edges in range(robots - 1, len(pairs) + 1):
        chosen = np.array(list(combinations(range(len(pairs)), edges)))
        keys = _keys(chosen)
        first = np.all([keys <= _keys(np.array(way)[chosen]) for way in moved], axis=0)
        graphs = [nx.empty_graph(robots) for _ in range(int(np.count_nonzero(first)))]
        for graph, row in zip(graphs, chosen[first], strict=True):
            graph.add_edges_from(pairs[k] for k in row)
        found[edges] = [graph for graph in graphs if nx.is_connected(graph)]
    return found


def _keys(edges: NDArray[np.int64]) -> NDArray[np.int64]:
    """A number for every set of edges; the copy with the smallest stands for its orbit."""
    result: NDArray[np.int64] = (1 << edges).sum(axis=1)
    return result
