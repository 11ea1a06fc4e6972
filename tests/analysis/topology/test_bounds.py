"""Bounds on the error of all graphs with so many edges: no graph beats them, and they are near the best."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import generators

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.response.error_criteria import ForceNoise, Pulse, Vibration
from drake_formation.analysis.topology.bounds import SLACK, least_error, relative_modes
from drake_formation.analysis.topology.enumeration import connected_graphs
from drake_formation.analysis.topology.reduced_graphs import with_all_channels, with_channels
from drake_formation.formation import graphs

LIKE = {
    "rubber": {"consensus.delta": 2e4},
    "steel": {"consensus.delta": 1e4, "springs.stiffness": 3e4},
    "springs of all kinds": {"consensus.delta": 50.0, "springs.stiffness": [0.0, 30.0, 100.0, 3.0, 1.0, 500.0]},
    "linear and damped": {
        "consensus.delta": 300.0,
        "consensus.delta_v": 30.0,
        "springs.law": "linear",
        "springs.stiffness": 200.0,
        "springs.damping": 20.0,
    },
    "one axis stiffer": {"consensus.delta": 50.0, "springs.stiffness": 0.0, "tracking.Q": [1.0, 9.0, 1.0, 4.0]},
}


def complete_of(overrides, name="quadrilateral"):
    return with_all_channels(linearize(load_scenario(name, overrides=overrides)))


@pytest.mark.parametrize("measure", [Pulse(2.0), ForceNoise(0.5)])
@pytest.mark.parametrize("kind", LIKE)
def test_no_graph_beats_the_bound(kind, measure):
    complete = complete_of(LIKE[kind])
    bound = least_error(complete, measure)
    for edges, candidates in connected_graphs(4, [tuple(range(4))]).items():
        errors = [measure.error_m(with_channels(complete, graph)) for graph in candidates]
        assert 0 < bound(edges) <= min(errors)
        # Where robots are held unlike, the bound must allow for the one held firmest.
        assert bound(edges) >= (0.4 if kind == "springs of all kinds" else 0.7) * min(errors)


@given(rng=generators, robots=st.integers(5, 9))
@settings(max_examples=10)
def test_no_random_graph_of_more_robots_beats_it(rng, robots):
    overrides = {
        "formation": {"shape": "polygon", "robots": robots, "side": 1.0},
        "robots.start": {"centre": [0, 0]},
        "consensus.delta": float(10 ** rng.uniform(0, 4)),
        "springs.stiffness": float(10 ** rng.uniform(0, 4)),
        "robots.mass": float(rng.uniform(5, 80)),
    }
    complete = complete_of(overrides, "octagon")
    bounds = [(measure, least_error(complete, measure)) for measure in (Pulse(), ForceNoise())]
    for _ in range(5):
        graph = _random_graph(rng, robots)
        for measure, bound in bounds:
            assert bound(graph.number_of_edges()) <= measure.error_m(with_channels(complete, graph))


def _random_graph(rng, robots):
    tree = [(int(rng.integers(i)), i) for i in range(1, robots)]
    odds = rng.random()
    return graphs.graph([*tree, *((j, i) for i in range(robots) for j in range(i) if rng.random() < odds)], robots)


@pytest.mark.parametrize("measure", [Pulse(), ForceNoise()])
def test_the_complete_graph_attains_it_where_springs_are_alike(measure):
    """All its relative modes are one, so that there is nothing to lose by taking means."""
    complete = complete_of({"consensus.delta": 1e4, "springs.law": "linear"})
    assert least_error(complete, measure)(6) == pytest.approx(measure.error_m(complete), rel=4 * SLACK)


def test_more_edges_allow_smaller_errors():
    bound = least_error(complete_of({"consensus.delta": 1e4}, "octagon"), Pulse())
    errors = np.array([bound(edges) for edges in range(7, 29)])
    assert np.all(np.diff(errors) <= 0)
    assert errors[-1] < errors[0]


@pytest.mark.parametrize(
    ("overrides", "measure"),
    [
        ({"consensus.delta": 1e4, "consensus.delta_v": 5.0}, Pulse()),
        ({"consensus.delta": 1e4, "springs.damping": 5.0}, ForceNoise()),
        ({"consensus.delta": 1e4, "robots.mass": [40.0, 40.0, 40.0, 50.0]}, Pulse()),
        ({"consensus.delta": 1e4}, Vibration()),
    ],
)
def test_where_nothing_is_known_the_bound_is_nothing(overrides, measure):
    assert least_error(complete_of(overrides), measure)(3) == 0.0


def test_modes_are_those_of_the_loop():
    """On a cycle of four the relative modes are λ = 2, 2, 4."""
    complete = complete_of(LIKE["linear and damped"])
    modes = relative_modes(complete)
    loop = np.linalg.eigvals(with_channels(complete, graphs.graph("cycle", 4)).A)
    for eigenvalue in (2.0, 4.0):
        for value in np.linalg.eigvals(modes.fixed + eigenvalue * modes.varied):
            assert np.abs(loop - value).min() < 1e-6
