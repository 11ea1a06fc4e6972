"""Undirected graphs between robots: who is coupled to whom, physically or by communication.

Robots are numbered from 0 here, as arrays are; users number them from 1.
"""

from collections.abc import Iterable

import networkx as nx
import numpy as np
from numpy.typing import NDArray

Edge = tuple[int, int]


def graph(topology: str | Iterable[Edge], robots: int) -> nx.Graph:
    """A graph by name or by its edges.

    Args:
        topology: ``complete``, ``cycle``, ``path``, ``star`` (about robot 0), or edges between robots from 0.
        robots: number of robots N.

    Returns:
        A graph on the nodes 0 … N-1.

    Raises:
        ValueError: the name is unknown, or an edge is a loop or leaves the robots.
    """
    if not isinstance(topology, str):
        return _from_edges(topology, robots)
    if topology == "complete":
        return nx.complete_graph(robots)
    if topology == "cycle":
        # Two robots on a cycle share one edge and a single robot has none; networkx would give loops.
        return nx.cycle_graph(robots) if robots > 2 else nx.path_graph(robots)
    if topology == "path":
        return nx.path_graph(robots)
    if topology == "star":
        return nx.star_graph(robots - 1)
    raise ValueError(f"unknown topology {topology!r}: complete, cycle, path, star or a list of edges")


def _from_edges(edges: Iterable[Edge], robots: int) -> nx.Graph:
    result = nx.empty_graph(robots)
    for i, j in edges:
        if i == j or not {i, j} <= set(range(robots)):
            raise ValueError(f"edge ({i}, {j}) does not join two of the robots 0 … {robots - 1}")
        result.add_edge(i, j)
    return result


def edges(graph: nx.Graph) -> list[Edge]:
    """Edges (i, j) with i < j, sorted: the order in which per-edge quantities are given."""
    return sorted([(i, j) if i < j else (j, i) for i, j in graph.edges])


def neighbours(graph: nx.Graph, robot: int) -> list[int]:
    """Neighbours of a robot in ascending order: the order of its ports."""
    return sorted(graph.neighbors(robot))


def laplacian(graph: nx.Graph) -> NDArray[np.float64]:
    """Laplacian L = D − Γ, shape (N, N) (paper, Sec. 2.1)."""
    matrix: NDArray[np.float64] = nx.laplacian_matrix(graph, nodelist=sorted(graph)).toarray().astype(float)
    return matrix


def in_degrees(graph: nx.Graph) -> NDArray[np.int64]:
    """In-degree of every robot, shape (N,)."""
    return np.array([graph.degree(robot) for robot in sorted(graph)], dtype=np.int64)


def algebraic_connectivity(graph: nx.Graph) -> float:
    """Second-smallest Laplacian eigenvalue; positive if and only if the graph is connected (paper, Lemma 1).

    A single robot agrees with itself at any rate: infinity.
    """
    if graph.number_of_nodes() < 2:
        return float("inf")
    return float(max(np.linalg.eigvalsh(laplacian(graph))[1], 0.0)) if nx.is_connected(graph) else 0.0


def channels(graph: nx.Graph) -> int:
    """Communication channels: two an edge, one each way (paper, Sec. 5.4)."""
    return 2 * int(graph.number_of_edges())
