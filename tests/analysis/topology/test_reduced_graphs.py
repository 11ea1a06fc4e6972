"""One linearization serves every graph; renumberings that change nothing."""

from itertools import permutations

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.response.error_criteria import ForceNoise
from drake_formation.analysis.topology.reduced_graphs import (
    interchangeable,
    renumberings,
    with_all_channels,
    with_channels,
)
from drake_formation.formation import graphs
from drake_formation.scenario import resolve

ALIKE = {"springs.law": "linear", "consensus.delta": 50.0, "consensus.delta_v": 5.0}


def complete_of(name, **overrides):
    named = {path.replace("__", "."): value for path, value in overrides.items()}
    return with_all_channels(linearize(load_scenario(name, overrides=named)))


@given(scenario=scenarios(robots=st.integers(2, 5)))
@settings(max_examples=15)
def test_picked_channels_are_the_diagram_linearized_anew(scenario):
    formation = linearize(scenario)
    picked = with_channels(with_all_channels(formation), resolve(scenario).channels.graph)
    np.testing.assert_allclose(picked.A, formation.A, rtol=1e-9, atol=1e-9 * np.abs(formation.A).max())
    np.testing.assert_array_equal(picked.B, formation.B)
    np.testing.assert_array_equal(picked.laplacian, formation.laplacian)


def test_robots_without_springs_are_interchangeable():
    assert interchangeable(complete_of("quadrilateral", springs__stiffness=0.0))


def test_equal_linear_springs_leave_robots_interchangeable():
    assert interchangeable(complete_of("octagon", springs__law="linear", springs__damping=3.0))


@pytest.mark.parametrize(
    "overrides",
    [
        {},
        {"springs__law": "linear", "springs__graph": "cycle"},
        {"springs__stiffness": 0.0, "robots__mass": [40.0, 40.0, 40.0, 41.0]},
        {"springs__law": "linear", "springs__stiffness": [1.0, 1.0, 1.0, 1.0, 1.0, 2.0]},
    ],
)
def test_what_makes_robots_differ(overrides):
    assert not interchangeable(complete_of("quadrilateral", **overrides))


@pytest.mark.parametrize(
    ("name", "overrides", "count"),
    [
        ("line", {}, 2),
        ("quadrilateral", {}, 8),
        ("quadrilateral", {"springs__law": "linear"}, 24),
        ("quadrilateral", {"robots__mass": [40.0, 41.0, 40.0, 41.0]}, 4),
        ("quadrilateral", {"robots__mass": [40.0, 41.0, 42.0, 43.0]}, 1),
        ("quadrilateral", {"tracking__Q": [1.0, 2.0, 1.0, 1.0]}, 4),
        ("octagon", {}, 1),
    ],
)
def test_symmetries_of_a_formation(name, overrides, count):
    """A square has eight; eight robots are too many to try every renumbering."""
    assert len(renumberings(complete_of(name, **overrides))) == count


def test_symmetries_form_a_group():
    group = set(renumberings(complete_of("quadrilateral")))
    assert tuple(range(4)) in group
    assert {tuple(one[i] for i in other) for one in group for other in group} == group


@pytest.mark.parametrize("overrides", [{}, {"tracking__Q": [1.0, 2.0, 1.0, 1.0]}])
def test_a_symmetry_leaves_the_error_of_every_graph(overrides):
    complete = complete_of("quadrilateral", springs__stiffness=300.0, consensus__delta=100.0, **overrides)
    group = renumberings(complete)
    path = nx.path_graph(4)
    errors = {way: ForceNoise().error_m(with_channels(complete, nx.relabel_nodes(path, dict(enumerate(way)))))
              for way in permutations(range(4))}  # fmt: skip
    for way in group:
        assert errors[way] == pytest.approx(errors[tuple(range(4))], rel=1e-9)
    assert max(errors.values()) > 1.01 * min(errors.values())


def test_interchangeable_robots_err_alike_on_every_copy_of_a_graph():
    complete = complete_of("quadrilateral", **{key.replace(".", "__"): value for key, value in ALIKE.items()})
    star = graphs.graph("star", 4)
    errors = [
        ForceNoise().error_m(with_channels(complete, nx.relabel_nodes(star, dict(enumerate(way)))))
        for way in permutations(range(4))
    ]
    np.testing.assert_allclose(errors, errors[0], rtol=1e-9)
