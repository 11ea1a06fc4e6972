"""Good communication graphs where there are too many to try them all.

The complete graph is thinned edge by edge, always of the edge whose loss raises the total effective resistance least
(Ghosh, Boyd, Saberi 2008); that resistance, N Σ 1/λ, is what the H2 error follows for stiff virtual springs. Then edges
are exchanged while the error itself falls.
"""

from collections.abc import Callable

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.formation import graphs

Array = NDArray[np.float64]
Error = Callable[[nx.Graph], float]

MOVES = 4
"""Edges considered for removal, and for addition, in an exchange."""

_BRIDGE = 1e-9


def thinned(robots: int) -> dict[int, nx.Graph]:
    """A connected graph for every number of edges from complete down to a tree."""
    graph = nx.complete_graph(robots)
    found = {graph.number_of_edges(): graph.copy()}
    while graph.number_of_edges() >= robots:
        graph.remove_edge(*_least_missed(graph)[0])
        found[graph.number_of_edges()] = graph.copy()
    return found


def starting_points(robots: int, edges: int, path: dict[int, nx.Graph]) -> list[nx.Graph]:
    """Graphs to begin a search from: the thinned one, Harary's, which spreads the edges evenly, and the star."""
    starts = [path[edges], nx.hnm_harary_graph(robots, edges)]
    return [*starts, graphs.graph("star", robots)] if edges == robots - 1 else starts


def exchanged(graph: nx.Graph, error: Error, *, enough: float = 0.0, evaluations: int = 60) -> tuple[nx.Graph, float]:
    """Exchange edges one for one while the error falls.

    Args:
        graph: connected; left as it is.
        error: what is to be small.
        enough: an error at which to stop.
        evaluations: errors computed at most.

    Returns:
        The best graph found and its error.
    """
    best, lowest = graph, error(graph)
    left = evaluations - 1
    improved = True
    while improved and left > 0 and lowest > enough:
        improved = False
        for candidate in _exchanges(best)[:left]:
            left -= 1
            found = error(candidate)
            if found < lowest * (1 - 1e-6):
                best, lowest, improved = candidate, found, True
                break
    return best, lowest


def _exchanges(graph: nx.Graph) -> list[nx.Graph]:
    """Graphs one exchange away, those that promise most first."""
    result = []
    for removed in _least_missed(graph)[:MOVES]:
        less = graph.copy()
        less.remove_edge(*removed)
        for added in _most_wanted(less, removed)[:MOVES]:
            other = less.copy()
            other.add_edge(*added)
            result.append(other)
    return result


def _least_missed(graph: nx.Graph) -> list[graphs.Edge]:
    """Edges that are no bridges, in the order of what their loss adds to the total effective resistance."""
    inverse = np.linalg.pinv(graphs.laplacian(graph), hermitian=True)
    missed = {}
    for edge in graphs.edges(graph):
        difference = inverse[edge[0]] - inverse[edge[1]]
        slack = 1 - (difference[edge[0]] - difference[edge[1]])
        if slack > _BRIDGE:
            missed[edge] = float(difference @ difference) / slack
    return sorted(missed, key=lambda edge: round(missed[edge], 12))


def _most_wanted(graph: nx.Graph, but: graphs.Edge) -> list[graphs.Edge]:
    """Edges that are not there, in the order of how much they lower the total effective resistance."""
    inverse = np.linalg.pinv(graphs.laplacian(graph), hermitian=True)
    wanted = {}
    for edge in graphs.edges(nx.complement(graph)):
        difference = inverse[edge[0]] - inverse[edge[1]]
        wanted[edge] = float(difference @ difference) / (1 + difference[edge[0]] - difference[edge[1]])
    return sorted((edge for edge in wanted if edge != but), key=lambda edge: round(-wanted[edge], 12))
