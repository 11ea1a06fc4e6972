"""Which graphs the study tries."""

import networkx as nx
import pytest

from drake_formation.paper.bandwidth.graphs import PLACEMENTS, placed_graphs, shapes


@pytest.mark.parametrize(("robots", "connected"), [(3, 2), (4, 6), (5, 21), (6, 112), (7, 853)])
def test_up_to_seven_robots_every_connected_graph_is_tried(robots, connected):
    none, *others = shapes(robots)
    assert none.number_of_edges() == 0
    assert len(others) == connected
    assert all(map(nx.is_connected, others))


@pytest.mark.parametrize(("robots", "labelled"), [(3, 4), (4, 38), (5, 728)])
def test_up_to_five_robots_stand_in_every_way(robots, labelled):
    """Connected graphs between numbered robots, OEIS A001187."""
    assert len(placed_graphs(robots)) == 1 + labelled


def test_six_robots_stand_in_some_ways_each_a_copy_of_its_shape():
    known = shapes(6)
    found = placed_graphs(6)
    for placed in found[::7]:
        assert nx.is_isomorphic(placed.graph, known[placed.shape])
    counted = [sum(one.shape == k for one in found) for k in range(len(known))]
    assert max(counted) == PLACEMENTS[6]
    assert min(counted) == 1
