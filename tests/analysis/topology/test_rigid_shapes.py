"""Minimally rigid graphs: as many as are known, and Laman's condition on each."""

from itertools import combinations

import networkx as nx
import numpy as np
import pytest

from drake_formation.analysis.topology.enumeration import connected_shapes
from drake_formation.analysis.topology.rigid_shapes import distinct, minimally_rigid_shapes
from drake_formation.formation import graphs
from drake_formation.formation.rigidity import rigid_rank, rigidity


def test_there_are_as_many_as_are_known():
    """OEIS A227117."""
    assert [len(minimally_rigid_shapes(robots)) for robots in range(2, 8)] == [1, 1, 1, 3, 13, 70]


@pytest.mark.parametrize("robots", range(2, 7))
def test_no_part_has_more_edges_than_hold_it(robots):
    for shape in minimally_rigid_shapes(robots):
        assert shape.number_of_edges() == rigid_rank(robots)
        for size in range(2, robots):
            for part in combinations(shape, size):
                assert shape.subgraph(part).number_of_edges() <= rigid_rank(size)


@pytest.mark.parametrize("robots", range(3, 7))
def test_they_are_all_that_the_rigidity_matrix_knows(robots):
    slots = np.random.default_rng(1).uniform(size=(robots, 2))
    candidates = connected_shapes(robots)[rigid_rank(robots)]
    known = [shape for shape in candidates if rigidity(slots, graphs.edges(shape)).minimally_rigid]
    assert len(known) == len(minimally_rigid_shapes(robots))


def test_copies_are_left_out():
    path, star = nx.path_graph(4), nx.star_graph(3)
    copy = nx.relabel_nodes(path, {0: 2, 2: 0})
    assert [id(graph) for graph in distinct([path, copy, star])] == [id(path), id(star)]
