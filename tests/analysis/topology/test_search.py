"""The search: connected all the way, never worse than where it began, and near the best where that is known."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.analysis.topology.enumeration import connected_shapes
from drake_formation.analysis.topology.search import exchanged, starting_points, thinned
from drake_formation.formation import graphs


def resistance(graph):
    """Total effective resistance N Σ 1/λ."""
    return graph.number_of_nodes() * (1 / np.linalg.eigvalsh(graphs.laplacian(graph))[1:]).sum()


@given(robots=st.integers(2, 12))
def test_thinning_stays_connected_and_only_takes_away(robots):
    path = thinned(robots)
    assert sorted(path) == list(range(robots - 1, robots * (robots - 1) // 2 + 1))
    for edges, graph in path.items():
        assert graph.number_of_edges() == edges
        assert nx.is_connected(graph)
        if edges + 1 in path:
            assert set(graph.edges) < set(path[edges + 1].edges)


def test_thinning_takes_the_edge_that_is_missed_least():
    path = thinned(6)
    for edges, graph in path.items():
        if edges + 1 not in path:
            continue
        losses = []
        for edge in path[edges + 1].edges:
            less = path[edges + 1].copy()
            less.remove_edge(*edge)
            if nx.is_connected(less):
                losses.append(resistance(less))
        assert resistance(graph) == pytest.approx(min(losses))


@pytest.mark.parametrize("robots", [5, 6, 7])
def test_the_search_comes_near_the_best_graph(robots):
    path = thinned(robots)
    for edges, candidates in connected_shapes(robots).items():
        best = min(resistance(graph) for graph in candidates)
        found = min(exchanged(start, resistance)[1] for start in starting_points(robots, edges, path))
        assert best * (1 - 1e-9) <= found <= 1.02 * best


def test_exchanges_keep_the_number_of_edges_and_never_get_worse():
    start = nx.path_graph(9)
    graph, error = exchanged(start, resistance)
    assert graph.number_of_edges() == start.number_of_edges()
    assert nx.is_connected(graph)
    assert error == resistance(graph) <= resistance(start)


def test_exchanges_count_and_stop_when_it_is_enough():
    tried = []

    def counted(graph):
        tried.append(graph)
        return resistance(graph)

    exchanged(nx.cycle_graph(9), counted, evaluations=5)
    assert len(tried) <= 5
    tried.clear()
    exchanged(nx.cycle_graph(9), counted, enough=np.inf)
    assert len(tried) == 1


@given(robots=st.integers(2, 9))
def test_starting_points_are_connected_graphs_of_as_many_edges(robots):
    path = thinned(robots)
    for edges in path:
        for graph in starting_points(robots, edges, path):
            assert graph.number_of_edges() == edges
            assert nx.is_connected(graph)
