"""Edge weights: known answers, duality, and that no other weights do better."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.solvers import CsdpSolver, MathematicalProgram
from strategies import generators

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.topology.optimal_weights import fastest_averaging, fastest_weights, weighted_laplacian
from drake_formation.formation import graphs

sizes = st.integers(3, 8)


def random_graph(rng, robots):
    """A random tree and every other edge at even odds."""
    tree = [(int(rng.integers(i)), i) for i in range(1, robots)]
    others = [pair for pair in nx.complete_graph(robots).edges if rng.random() < 0.5]
    return graphs.graph([*tree, *others], robots)


def connectivity(graph, weights):
    return np.linalg.eigvalsh(weighted_laplacian(graph, weights))[1]


def factor(graph, weights):
    robots = graph.number_of_nodes()
    return np.linalg.norm(np.eye(robots) - weighted_laplacian(graph, weights) - np.ones((robots, robots)) / robots, 2)


@given(robots=sizes)
@settings(max_examples=6)
@pytest.mark.parametrize("name", ["complete", "cycle", "star"])
def test_equal_edges_get_equal_weights(name, robots):
    graph = graphs.graph(name, robots)
    found = fastest_weights(graph)
    np.testing.assert_allclose(found.weights, 1 / graph.number_of_edges(), atol=1e-5)
    round_trip = (2 - 2 * np.cos(2 * np.pi / robots)) / robots
    expected = {"complete": 2 / (robots - 1), "cycle": round_trip, "star": 1 / (robots - 1)}[name]
    np.testing.assert_allclose(found.connectivity, expected, rtol=1e-6)
    np.testing.assert_allclose(found.uniform_connectivity, expected, rtol=1e-9)


@pytest.mark.parametrize("robots", [2, 3, 4, 7, 12])
def test_a_path_is_strongest_in_the_middle(robots):
    """Weights i (N − i), and λ₂ is one over the moment of inertia of equally spaced points (Fiedler 1990)."""
    found = fastest_weights(graphs.graph("path", robots))
    parabola = np.arange(1, robots) * np.arange(robots - 1, 0, -1)
    np.testing.assert_allclose(found.weights, parabola / parabola.sum(), atol=1e-5)
    np.testing.assert_allclose(found.connectivity, 12 / (robots * (robots**2 - 1)), rtol=1e-6)


@given(rng=generators, robots=sizes)
@settings(max_examples=15)
def test_duality_proves_the_connectivity(rng, robots):
    """1/λ₂ is the largest moment of inertia of points no farther apart than 1 along edges (Sun, Boyd, Xiao, Diaconis
    2006); solved by another solver.
    """
    graph = random_graph(rng, robots)
    program = MathematicalProgram()
    # Scalar products of all points relative to the first, which stays at the origin.
    gram = program.NewSymmetricContinuousVariables(robots - 1)
    program.AddPositiveSemidefiniteConstraint(gram)
    for i, j in graphs.edges(graph):
        apart = gram[j - 1, j - 1] if i == 0 else gram[i - 1, i - 1] + gram[j - 1, j - 1] - 2 * gram[i - 1, j - 1]
        program.AddLinearConstraint(apart <= 1)
    across = np.eye(robots - 1) - 1 / robots
    program.AddLinearCost(-sum(across[i, j] * gram[i, j] for i in range(robots - 1) for j in range(robots - 1)))
    dual = CsdpSolver().Solve(program)
    assert dual.is_success()
    np.testing.assert_allclose(fastest_weights(graph).connectivity, -1 / dual.get_optimal_cost(), rtol=1e-4)


@given(rng=generators, robots=sizes)
@settings(max_examples=15)
def test_no_other_weights_connect_better(rng, robots):
    graph = random_graph(rng, robots)
    found = fastest_weights(graph)
    assert found.weights.min() >= 0
    np.testing.assert_allclose(found.weights.sum(), 1)
    np.testing.assert_allclose(found.connectivity, connectivity(graph, found.weights), rtol=1e-9)
    np.testing.assert_allclose(
        found.uniform_connectivity * graph.number_of_edges(), graphs.algebraic_connectivity(graph), rtol=1e-9
    )
    for near in (1.0, 1e-2):
        other = np.abs(found.weights + near * rng.normal(size=(50, len(found.weights))) / len(found.weights))
        best = max(connectivity(graph, each / each.sum()) for each in other)
        assert best <= found.connectivity * (1 + 1e-5)


@given(robots=sizes)
@settings(max_examples=6)
@pytest.mark.parametrize("name", ["complete", "cycle", "star"])
def test_averaging_over_equal_edges(name, robots):
    """With all edges alike the best constant weight 2/(λ₂ + λ_N) is the best of all."""
    graph = graphs.graph(name, robots)
    found = fastest_averaging(graph)
    values = np.linalg.eigvalsh(graphs.laplacian(graph))
    slowest, fastest = values[1], values[-1]
    np.testing.assert_allclose(found.factor, (fastest - slowest) / (fastest + slowest), atol=1e-6)
    np.testing.assert_allclose(found.constant_factor, (fastest - slowest) / (fastest + slowest), atol=1e-9)


def test_two_robots_agree_in_one_step():
    found = fastest_averaging(graphs.graph("path", 2))
    np.testing.assert_allclose(found.weights, 0.5, atol=1e-6)
    np.testing.assert_allclose(found.factor, 0, atol=1e-6)


@given(rng=generators, robots=sizes)
@settings(max_examples=15)
def test_averaging_beats_every_rule_of_thumb(rng, robots):
    graph = random_graph(rng, robots)
    found = fastest_averaging(graph)
    np.testing.assert_allclose(found.factor, factor(graph, found.weights), atol=1e-9)
    rules = (found.constant_factor, found.metropolis_factor, found.maximum_degree_factor)
    assert found.factor <= min(rules) + 1e-7
    assert max(rules) < 1
    other = found.weights + rng.normal(size=(50, len(found.weights))) * 0.02
    assert found.factor <= min(factor(graph, each) for each in other) + 1e-7


def test_rules_of_thumb_on_a_star():
    """Four robots: both rules give every edge 1/4, so that λ = 1 leaves 3/4."""
    found = fastest_averaging(graphs.graph("star", 4))
    assert found.metropolis_factor == pytest.approx(0.75)
    assert found.maximum_degree_factor == pytest.approx(0.75)
    assert found.factor == pytest.approx(0.6, abs=1e-6)


def test_repeated_steps_contract_by_the_factor():
    graph = random_graph(np.random.default_rng(4), 7)
    found = fastest_averaging(graph)
    state = np.random.default_rng(5).normal(size=7)
    state -= state.mean()
    step = np.eye(7) - weighted_laplacian(graph, found.weights)
    after = np.linalg.matrix_power(step, 40) @ state
    assert np.linalg.norm(after) <= found.factor**40 * np.linalg.norm(state) * (1 + 1e-9)
    assert np.linalg.norm(after) > 0


@pytest.mark.parametrize("solve", [fastest_weights, fastest_averaging])
def test_what_cannot_agree_gets_no_weights(solve):
    with pytest.raises(IllPosedError, match="in 2 parts"):
        solve(graphs.graph([(0, 1)], 3))
    with pytest.raises(IllPosedError, match="at least two robots"):
        solve(graphs.graph("complete", 1))


def test_plain_values():
    graph = graphs.graph("star", 3)
    assert fastest_weights(graph).to_dict()["edges"] == [[1, 2], [1, 3]]
    assert fastest_averaging(graph).to_dict()["factor"] == pytest.approx(0.5, abs=1e-6)


def test_the_papers_ten_channels_are_eight():
    """Of a square with one diagonal the best weights leave the diagonal out (paper, Sec. 5.4)."""
    found = fastest_weights(graphs.graph([(0, 1), (0, 3), (1, 2), (1, 3), (2, 3)], 4))
    np.testing.assert_allclose(found.weights, [0.25, 0.25, 0.25, 0.0, 0.25], atol=1e-5)
    assert found.connectivity == pytest.approx(fastest_weights(graphs.graph("cycle", 4)).connectivity, rel=1e-6)
    assert found.uniform_connectivity == pytest.approx(0.4)
