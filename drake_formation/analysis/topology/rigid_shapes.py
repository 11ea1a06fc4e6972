"""All minimally rigid graphs between a few robots, each once: Henneberg's two steps from a single edge (Laman, 1970).

In general position they are what holds a formation's shape by the fewest distances, 2N − 3 of them. Whether one holds
it in the slots of a formation too is for its rigidity matrix to say.
"""

from collections.abc import Iterable, Iterator
from itertools import combinations

import networkx as nx


def minimally_rigid_shapes(robots: int) -> list[nx.Graph]:
    """All minimally rigid graphs up to isomorphism: 1, 1, 1, 3, 13, 70, 608 for 2 … 8 robots.

    Args:
        robots: number of robots N, at least 2.
    """
    shapes = [nx.complete_graph(2)]
    for _ in range(robots - 2):
        shapes = distinct(larger for shape in shapes for larger in _with_one_more(shape))
    return shapes


def distinct(candidates: Iterable[nx.Graph]) -> list[nx.Graph]:
    """One graph of every class of isomorphic ones, the first of each."""
    kept: dict[tuple[object, ...], list[nx.Graph]] = {}
    for graph in candidates:
        alike = kept.setdefault(_degrees(graph), [])
        if not any(nx.is_isomorphic(graph, other) for other in alike):
            alike.append(graph)
    return [graph for alike in kept.values() for graph in alike]


def _with_one_more(graph: nx.Graph) -> Iterator[nx.Graph]:
    """A robot joined to two others; or set into an edge, which it replaces, and joined to a third."""
    new = graph.number_of_nodes()
    for pair in combinations(graph, 2):
        yield _joined(graph, new, pair)
    for edge in graph.edges:
        opened = graph.copy()
        opened.remove_edge(*edge)
        for third in graph:
            if third not in edge:
                yield _joined(opened, new, (*edge, third))


def _joined(graph: nx.Graph, new: int, others: tuple[int, ...]) -> nx.Graph:
    larger = graph.copy()
    larger.add_edges_from((new, other) for other in others)
    return larger


def _degrees(graph: nx.Graph) -> tuple[object, ...]:
    """What isomorphic graphs have in common: how many neighbours the robots have, and their neighbours."""
    degree = dict(graph.degree)
    return tuple(sorted((nx.triangles(graph, i), *sorted(degree[j] for j in graph[i])) for i in graph))
