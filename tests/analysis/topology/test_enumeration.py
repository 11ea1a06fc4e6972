"""All graphs, each once: the counts of the literature, and orbits that add up."""

import networkx as nx
import pytest

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.topology.enumeration import catalogue, connected_graphs, connected_shapes
from drake_formation.analysis.topology.reduced_graphs import renumberings, with_all_channels

SHAPES = {2: 1, 3: 2, 4: 6, 5: 21, 6: 112, 7: 853}
"""Connected graphs up to isomorphism (OEIS A001349)."""

LABELLED = {2: 1, 3: 4, 4: 38, 5: 728, 6: 26704}
"""Connected graphs on numbered nodes (OEIS A001187)."""


def sizes(found):
    return sum(map(len, found.values()))


def complete(name, **overrides):
    named = {path.replace("__", "."): value for path, value in overrides.items()}
    return with_all_channels(linearize(load_scenario(name, overrides=named)))


@pytest.mark.parametrize(("robots", "count"), SHAPES.items())
def test_shapes_are_all_there_and_different(robots, count):
    found = connected_shapes(robots)
    assert sizes(found) == count
    assert list(found) == list(range(robots - 1, robots * (robots - 1) // 2 + 1))
    for edges, candidates in found.items():
        alike = {}
        for graph in candidates:
            assert nx.is_connected(graph)
            assert graph.number_of_edges() == edges
            same = alike.setdefault(tuple(sorted(dict(graph.degree).values())), [])
            assert not any(nx.is_isomorphic(graph, other) for other in same)
            same.append(graph)


@pytest.mark.parametrize(("robots", "count"), LABELLED.items())
def test_numbered_graphs_are_all_there(robots, count):
    assert sizes(connected_graphs(robots, [tuple(range(robots))])) == count


def test_orbits_add_up_to_all_graphs():
    group = renumberings(complete("quadrilateral"))
    orbits = connected_graphs(4, group)
    members = set()
    for candidates in orbits.values():
        for graph in candidates:
            orbit = {frozenset(frozenset((way[i], way[j])) for i, j in graph.edges) for way in group}
            assert not orbit & members
            members |= orbit
    assert len(members) == LABELLED[4]


def test_which_graphs_are_tried():
    graphs, words = catalogue(complete("quadrilateral"), of_every_robot=True)
    assert (sizes(graphs), words.format(11)) == (11, "all 11 connected graphs up to the formation's 8 symmetries")
    graphs, words = catalogue(complete("quadrilateral", springs__law="linear"), of_every_robot=True)
    assert (sizes(graphs), words.format(6)) == (6, "all 6 connected graphs up to isomorphism")
    graphs, words = catalogue(complete("quadrilateral", springs__law="linear"), of_every_robot=False)
    assert (sizes(graphs), words.format(38)) == (38, "all 38 connected graphs")
    assert catalogue(complete("octagon"), of_every_robot=True) is None
