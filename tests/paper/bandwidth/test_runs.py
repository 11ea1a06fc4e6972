"""The transports of the study: who feels what, and one hand-off for all."""

import networkx as nx
import numpy as np
import pytest

from drake_formation.paper.bandwidth.runs import (
    formation,
    handed_over,
    nearest_in_formation,
    settings,
    talk_over,
    transport,
)
from drake_formation.scenario import resolve, with_overrides


def test_the_front_one_of_the_robots_that_pass_nearest_feels_an_obstacle():
    assert nearest_in_formation(resolve(formation(4))) == settings(4).assigned == (4, 3)  # upper right, lower right
    assert settings(8).assigned == (8, 5)
    assert nearest_in_formation(resolve(formation(5)))[1] == 3  # the lower corner alone


@pytest.mark.parametrize("robots", [5, 6])
def test_formations_are_one_metre_across(robots):
    slots = resolve(formation(robots)).slots
    assert slots[:, 1].max() == pytest.approx(0.5)


def test_graphs_differ_in_nothing_but_their_channels():
    one, other = (transport(nx.path_graph(4), law) for law in ("hookean", "linear"))
    assert with_overrides(other, {"consensus.law": "hookean"}) == one
    starts = [resolve(run).starts for run in (one, transport(nx.complete_graph(4), "linear"), handed_over(4))]
    assert all(np.array_equal(start, starts[0]) for start in starts)
    assert resolve(one).channels.counted == [(0, 1), (1, 2), (2, 3)]


def test_without_channels_there_is_no_consensus():
    assert talk_over(nx.empty_graph(3))["consensus.delta"] == 0.0
    assert "consensus.delta" not in talk_over(nx.path_graph(3))
