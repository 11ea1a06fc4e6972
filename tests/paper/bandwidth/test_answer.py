"""The answer: its numbers are those of the study, and its sentences are true of them."""

import networkx as nx
import numpy as np
import pytest

from drake_formation.paper.bandwidth import answer
from drake_formation.paper.bandwidth.findings import Findings, framework
from drake_formation.paper.bandwidth.graphs import ROBOTS
from drake_formation.paper.bandwidth.runs import LAWS
from drake_formation.paper.bandwidth.study import Tried, kept


@pytest.fixture(scope="module")
def found():
    return Findings(kept())


def test_kinds_of_graphs_are_apart_and_all(found):
    kinds = [found.minimally_rigid, found.braced, found.flexible]
    assert sum(map(len, kinds)) == len(found.connected) == len(kept()) - len(ROBOTS)
    assert {one.channels for one in found.of(4).minimally_rigid} == {10}


@pytest.mark.parametrize("robots", ROBOTS)
def test_the_fewest_channels_that_make_a_shape_rigid_do_as_well_as_all(found, robots):
    assert min(found.ratios(found.of(robots).minimally_rigid)) < 1.01
    assert np.median(found.ratios(found.of(robots).rigid)) < answer.AS_GOOD
    assert np.median(found.ratios(found.of(robots).flexible)) > answer.AS_GOOD


def test_a_complete_polygon_resists_every_change_of_shape_with_half_its_robots(found):
    assert [framework(found.complete[robots]).softest for robots in ROBOTS] == pytest.approx(
        [robots / 2 for robots in ROBOTS]
    )


def test_what_is_said_of_the_flexible_graph_with_most_channels_is_so(found):
    largest = max(one.channels for one in found.flexible)
    assert all(min(dict(one.graph.degree).values()) == 1 for one in found.flexible if one.channels == largest)


def test_three_that_hear_three_others_are_flexible_on_a_circle_alone(found):
    utilities = nx.complete_bipartite_graph(3, 3)
    assert any(nx.is_isomorphic(one.graph, utilities) for one in found.only_here_flexible)


def test_numbers_in_the_sentences_follow_the_study(found):
    largest = max(found.flexible, key=lambda one: (one.channels, one.errors["hookean"]))
    assert f"reach {largest.errors['hookean']:.2f} cm" in answer.of_flexible(found)
    worse = Tried(largest.shape, largest.graph, largest.rank, dict.fromkeys(LAWS, 77.77))
    changed = Findings([worse if one is largest else one for one in found.tried])
    assert "reach 77.77 cm" in answer.of_flexible(changed)
    assert answer.by_robots_table(changed) != answer.by_robots_table(found)


def test_the_papers_four_robots_need_ten_channels():
    assert "10 channels for 4 robots and 26 for 8, instead of 12 and 56" in answer.in_short()
