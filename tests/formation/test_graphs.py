import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from drake_formation.formation import graphs

NAMES = ["complete", "cycle", "path", "star"]


@st.composite
def any_graph(draw):
    robots = draw(st.integers(1, 12))
    robot = st.integers(0, robots - 1)
    edges = draw(st.lists(st.tuples(robot, robot).filter(lambda edge: edge[0] != edge[1]), max_size=20 * (robots > 1)))
    return graphs.graph(edges, robots)


@given(any_graph())
def test_a_laplacian_is_symmetric_positive_semi_definite_with_zero_row_sums(graph):
    laplacian = graphs.laplacian(graph)
    assert_array_equal(laplacian, laplacian.T)
    assert_array_equal(laplacian.sum(axis=1), np.zeros(len(graph)))
    assert np.linalg.eigvalsh(laplacian)[0] >= -1e-12


@given(any_graph())
def test_a_graph_is_connected_if_and_only_if_its_laplacian_has_rank_n_minus_1(graph):
    connected = nx.is_connected(graph)
    assert (np.linalg.matrix_rank(graphs.laplacian(graph)) == len(graph) - 1) == connected
    assert (graphs.algebraic_connectivity(graph) > 0) == connected


@given(any_graph())
def test_every_edge_is_two_channels_and_two_in_degrees(graph):
    assert graphs.channels(graph) == 2 * len(graphs.edges(graph)) == graphs.in_degrees(graph).sum()


@given(any_graph())
def test_neighbours_edges_and_laplacian_agree(graph):
    edges = graphs.edges(graph)
    assert edges == sorted(set(edges))
    assert all(i < j for i, j in edges)
    for robot in graph:
        neighbours = graphs.neighbours(graph, robot)
        assert neighbours == sorted(neighbours)
        assert neighbours == [other for other in graph if (min(robot, other), max(robot, other)) in edges]
        assert_array_equal(np.flatnonzero(graphs.laplacian(graph)[robot] == -1), neighbours)


@pytest.mark.parametrize("name", NAMES)
@given(robots=st.integers(1, 12))
def test_named_graphs_are_connected_without_loops(name, robots):
    graph = graphs.graph(name, robots)
    assert sorted(graph) == list(range(robots))
    assert nx.is_connected(graph)
    assert nx.number_of_selfloops(graph) == 0


@pytest.mark.parametrize(("name", "channels"), [("complete", 12), ("cycle", 8), ("path", 6), ("star", 6)])
def test_channels_of_four_robots(name, channels):
    assert graphs.channels(graphs.graph(name, 4)) == channels


@given(st.integers(2, 12))
def test_the_algebraic_connectivity_of_known_graphs(robots):
    assert_allclose(graphs.algebraic_connectivity(graphs.graph("complete", robots)), robots)
    path = 2 - 2 * np.cos(np.pi / robots)
    assert_allclose(graphs.algebraic_connectivity(graphs.graph("path", robots)), path, rtol=1e-9)


def test_a_star_is_about_the_first_robot():
    assert graphs.edges(graphs.graph("star", 4)) == [(0, 1), (0, 2), (0, 3)]


def test_one_robot_agrees_with_itself_at_once():
    assert graphs.algebraic_connectivity(graphs.graph("complete", 1)) == float("inf")


@pytest.mark.parametrize("edge", [(0, 0), (0, 3), (-1, 0)])
def test_edges_join_two_of_the_robots(edge):
    with pytest.raises(ValueError, match="does not join two of the robots"):
        graphs.graph([edge], 3)


def test_unknown_names_are_refused():
    with pytest.raises(ValueError, match="unknown topology 'ring'"):
        graphs.graph("ring", 3)
