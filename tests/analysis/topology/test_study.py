"""Trying graphs: what is counted, and which numbers of edges are looked at."""

import pytest

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.response.error_criteria import ForceNoise
from drake_formation.analysis.topology.study import FRONT, GraphStudy
from drake_formation.formation import graphs


def study_of(name, exhaustive=3000, **overrides):
    named = {path.replace("__", "."): value for path, value in overrides.items()}
    formation = linearize(load_scenario(name, overrides={"consensus.delta": 100.0, **named}))
    return GraphStudy(formation, ForceNoise(), exhaustive)


def test_every_error_is_kept_with_its_channels():
    study = study_of("quadrilateral")
    error = study.error(graphs.graph("cycle", 4))
    assert study.tried == [(8, error)]


def test_few_graphs_are_all_tried_and_many_are_not():
    assert study_of("quadrilateral").all_graphs is not None
    assert study_of("quadrilateral", exhaustive=10).all_graphs is None
    assert study_of("octagon").all_graphs is None


def test_edges_of_a_front():
    edges = study_of("octagon").some_edges()
    assert (edges[0], edges[-1]) == (7, 28)
    assert len(edges) <= FRONT


@pytest.mark.parametrize("bound", [1e-3, 3e-3, 1e-2])
def test_least_edges_agree_with_the_bound_on_the_error(bound):
    study = study_of("octagon")
    least = study.least_edges(bound)
    if least > 7:
        assert study.least_error(least - 1) > bound
    if least <= study.most_edges:
        assert study.least_error(least) <= bound
