"""Edges and channels say the same as the matrices of graph theory."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.formation.links import Channels, Edges


@st.composite
def edges(draw):
    robots = draw(st.integers(1, 6))
    pairs = [(i, j) for i in range(robots) for j in range(i)]
    graph = nx.empty_graph(robots)
    graph.add_edges_from(draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else [])
    return Edges.of(graph)


@st.composite
def channels(draw):
    robots = draw(st.integers(1, 5))
    pairs = [(i, j) for i in range(robots) for j in range(robots) if i != j]
    chosen = draw(st.lists(st.sampled_from(pairs), unique=True)) if pairs else []
    weights = draw(st.lists(st.sampled_from([0.0, 0.5, 1.0, 3.0]), min_size=len(chosen), max_size=len(chosen)))
    return Channels.of(robots, [(i, j, w) for (i, j), w in zip(chosen, weights, strict=True)])


@given(edges())
def test_every_robots_edges_lead_to_its_neighbours_in_their_order(edges):
    for robot in range(edges.robots):
        ends = [set(edges.pairs[row].tolist()) - {robot} for row in edges.incident(robot)]
        assert ends == [{j} for j in edges.neighbours[robot]]


@given(edges())
def test_lengths_are_distances(edges):
    places = np.arange(2.0 * edges.robots).reshape(-1, 2) ** 2
    for (i, j), length in zip(edges.pairs, edges.lengths(places), strict=True):
        assert length == pytest.approx(np.hypot(*(places[i] - places[j])))


@given(channels())
def test_what_is_heard_weighs_as_the_adjacency_says(channels):
    for robot in range(channels.robots):
        row = channels.adjacency[robot, list(channels.heard[robot])]
        np.testing.assert_array_equal(row, channels.weights_of(robot))
    assert channels.adjacency.sum() == channels.weights.sum()


@given(channels())
def test_constants_are_in_the_laplacians_kernel(channels):
    np.testing.assert_allclose(channels.laplacian @ np.ones(channels.robots), 0, atol=1e-12)


@given(channels())
def test_robots_agree_if_and_only_if_the_laplacian_has_rank_n_minus_1(channels):
    """The paper's Lemma 1; a directed graph has a spanning tree just then."""
    assert channels.agree == (np.linalg.matrix_rank(channels.laplacian, tol=1e-9) == channels.robots - 1)


@given(channels())
def test_undirected_channels_have_a_symmetric_laplacian(channels):
    assert channels.undirected == np.array_equal(channels.laplacian, channels.laplacian.T)


@given(channels())
def test_nothing_can_be_written_to(channels):
    for array in (channels.pairs, channels.weights):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


def test_channels_count_once_and_with_a_weight():
    channels = Channels.of(4, [(1, 0, 1.0), (0, 1, 0.5), (2, 3, 2.0), (3, 1, 0.0)])
    assert channels.counted == [(0, 1), (2, 3)]
