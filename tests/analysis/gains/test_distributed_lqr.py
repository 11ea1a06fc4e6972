"""Distributed LQR of Borrelli and Keviczky: the theorem, the centralised optimum, the spectrum and the diagram."""

import json

import networkx as nx
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm, solve_continuous_are, solve_continuous_lyapunov
from strategies import cost, generators
from unstable import UNSTABLE_BY_SPRINGS

from drake_formation import load_scenario, simulate
from drake_formation.analysis import linearize
from drake_formation.analysis.gains.distributed_lqr import distributed_lqr, relative_cost_of
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.parts.tracking.costs import cost_matrix
from drake_formation.scenario import resolve, with_overrides

CONNECTED = [g for g in nx.graph_atlas_g() if 2 <= g.number_of_nodes() <= 5 and nx.is_connected(g)]


def on_graph(graph, **changes):
    """Robots in a row, as many as the graph has nodes, that talk along its edges."""
    edges = [[i + 1, j + 1] for i, j in graph.edges]
    shape = {"shape": "line", "robots": graph.number_of_nodes(), "side": 0.5}
    fixed = {"formation": shape, "robots.start": {"centre": [2.5, 3.5]}, "consensus.graph": edges}
    return load_scenario("line", overrides={**fixed, **{k.replace("__", "."): v for k, v in changes.items()}})


def whole_problem(formation, relative):
    """A, B, Q and R of all robots as one system, springs left out."""
    tracking = formation.scenario.tracking
    robots, mass = formation.robots, resolve(formation.scenario).masses[0]
    plant = np.kron(np.eye(robots), np.eye(4, k=2))
    force = np.kron(np.eye(robots), np.vstack([np.zeros((2, 2)), np.eye(2) / mass]))
    state = np.kron(np.eye(robots), cost_matrix(tracking.Q, 4)) + np.kron(formation.laplacian, relative)
    return plant, force, state, np.kron(np.eye(robots), cost_matrix(tracking.R, 2))


def whole_gain(formation, found):
    return np.kron(np.eye(formation.robots), found.K1) + np.kron(formation.laplacian, found.K2)


@pytest.mark.parametrize("graph", CONNECTED, ids=str)
def test_every_connected_graph_is_stable(graph):
    formation = linearize(on_graph(graph, springs__stiffness=100.0))
    found = distributed_lqr(formation, relative_cost=[30.0, 30.0, 4.0, 4.0])
    assert found.systems == max(degree for _, degree in graph.degree) + 1
    plant, force, _, _ = whole_problem(formation, found.relative_cost)
    values = np.linalg.eigvals(plant - force @ whole_gain(formation, found))
    assert -values.real.max() == pytest.approx(found.decay_without_springs, rel=1e-6)
    assert found.decay_without_springs > 0
    assert found.stable
    loop = formation.closed_loop(found.delta, found.delta_v)
    assert -np.linalg.eigvals(loop).real.max() == pytest.approx(found.decay_with_springs, rel=1e-6)


@given(graph=st.sampled_from(CONNECTED), rng=generators)
@settings(max_examples=30, deadline=None)
def test_the_condition_on_the_spectrum_is_sufficient_for_any_weights(graph, rng):
    formation = linearize(on_graph(graph, tracking__Q=cost(rng, 4, False), tracking__R=cost(rng, 2, False)))
    sufficient = distributed_lqr(formation, relative_cost=cost(rng, 4, False)).sufficient_scale
    found = distributed_lqr(formation, relative_cost=cost(rng, 4, False), scale=1.001 * sufficient)
    assert found.guaranteed
    assert found.decay_without_springs > 0
    smallest = np.linalg.eigvalsh(formation.laplacian)[1]
    assert sufficient * smallest == pytest.approx(found.systems / 2)


@given(robots=st.integers(2, 5), rng=generators)
@settings(max_examples=15, deadline=None)
def test_where_all_see_each_other_it_is_the_centralised_optimum(robots, rng):
    weights = {"tracking__Q": cost(rng, 4, False), "tracking__R": cost(rng, 2, False)}
    formation = linearize(on_graph(nx.complete_graph(robots), **weights))
    found = distributed_lqr(formation, relative_cost=cost(rng, 4, False))
    plant, force, state, effort = whole_problem(formation, found.relative_cost)
    riccati = solve_continuous_are(plant, force, state, effort)
    optimum = np.linalg.solve(effort, force.T @ riccati)
    np.testing.assert_allclose(whole_gain(formation, found), optimum, atol=1e-6 * np.abs(optimum).max())
    assert found.cost == pytest.approx(found.optimal_cost, rel=1e-6)
    assert found.optimal_cost == pytest.approx(np.trace(riccati), rel=1e-6)
    assert found.scale == 1.0
    assert found.guaranteed


@pytest.mark.parametrize("graph", [nx.path_graph(4), nx.star_graph(3), nx.cycle_graph(5)], ids=str)
def test_costs_are_those_of_the_whole_problem(graph):
    formation = linearize(on_graph(graph))
    found = distributed_lqr(formation, relative_cost=50.0)
    plant, force, state, effort = whole_problem(formation, found.relative_cost)
    gain = whole_gain(formation, found)
    loop = plant - force @ gain
    spent = solve_continuous_lyapunov(loop.T, -(state + gain.T @ effort @ gain))
    assert found.cost == pytest.approx(np.trace(spent))
    assert found.optimal_cost == pytest.approx(np.trace(solve_continuous_are(plant, force, state, effort)))
    assert found.optimal_cost < found.cost < 1.2 * found.optimal_cost


def test_no_relative_cost_asks_for_no_consensus():
    found = distributed_lqr(linearize(load_scenario("octagon")), relative_cost=0.0)
    assert (found.delta, found.delta_v) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert found.cost == pytest.approx(found.optimal_cost)


def test_gains_have_a_formula():
    """K of a double integrator: k = √(q/r), d = √(q_v/r + 2mk)."""
    found = distributed_lqr(linearize(load_scenario("octagon", overrides={"consensus.graph": "cycle"})))
    np.testing.assert_allclose(found.K1, [[1, 0, 9, 0], [0, 1, 0, 9]], atol=1e-9)
    stiffness = np.sqrt(1 + 3)
    assert found.delta == pytest.approx((stiffness - 1) / 3)
    assert found.delta_v == pytest.approx((np.sqrt(1 + 3 + 80 * stiffness) - 9) / 3)


@pytest.mark.parametrize("delta", [1.0, 1e4])
def test_a_relative_cost_for_a_gain(delta):
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.graph": "path"}))
    assert distributed_lqr(formation, relative_cost=relative_cost_of(formation, delta)).delta == pytest.approx(delta)


def test_the_scenario_with_these_gains_moves_as_the_design():
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.graph": "path", "springs.stiffness": 0}))
    found = distributed_lqr(formation, relative_cost=[400.0, 400.0, 0.0, 0.0])
    displaced = np.array([[0.03, 0.0], [-0.01, 0.02], [0.0, -0.04], [0.02, 0.01]])
    start = resolve(formation.scenario).slots + np.array(formation.scenario.transport.goal) + displaced
    gains = {"consensus.delta": found.delta, "consensus.delta_v": found.delta_v}
    changes = {"robots.start": start.tolist(), "transport.duration": 3.0, "simulator.accuracy": 1e-10, **gains}
    result = simulate(with_overrides(formation.scenario, changes))
    plant, force, _, _ = whole_problem(formation, found.relative_cost)
    deviation = np.hstack([displaced, np.zeros_like(displaced)]).ravel()
    designed = expm((plant - force @ whole_gain(formation, found)) * 3.0) @ deviation
    last = result.isel(time=-1)
    moved = np.concatenate([last.position - last.goal - last.slot, last.velocity], axis=-1)
    np.testing.assert_allclose(moved.ravel(), designed, atol=1e-8)


def test_springs_may_undo_what_the_theorem_guarantees():
    """Input costs that tie x to y give a damping that is not symmetric; a stiff object across it then feeds motion."""
    formation = linearize(load_scenario("line", overrides=UNSTABLE_BY_SPRINGS))
    found = distributed_lqr(formation, relative_cost=[1.0, 1.0, 0.0, 0.0])
    assert found.guaranteed
    assert found.decay_without_springs > 0
    assert not found.stable
    plant, force, _, _ = whole_problem(formation, found.relative_cost)
    values = np.linalg.eigvals(plant - force @ whole_gain(formation, found) + formation.springs)
    assert found.decay_with_springs == pytest.approx(-values.real.max(), rel=1e-6)


def test_a_gain_that_is_not_isotropic_has_no_two_numbers():
    formation = linearize(load_scenario("line"))
    found = distributed_lqr(formation, relative_cost=[1.0, 9.0, 0.0, 0.0])
    assert found.delta is None
    assert found.delta_v is None
    assert found.stable


def test_it_is_plain_json():
    assert json.loads(json.dumps(distributed_lqr(linearize(load_scenario("line"))).to_dict()))["systems"] == 2


@pytest.mark.parametrize(
    ("changes", "question", "words"),
    [
        ({"formation": {"shape": "slots", "slots": [[0, 0]]}, "robots.start": {"centre": [0, 0]}}, {}, "one robot"),
        ({"robots.mass": [20.0, 40.0]}, {}, "identical robots"),
        ({}, {"relative_cost": -1.0}, "semi-definite"),
        ({}, {"relative_cost": np.triu(np.ones((4, 4)))}, "symmetric"),
        ({}, {"relative_cost": np.nan}, "finite"),
        ({}, {"scale": 0.0}, "above 0"),
    ],
)
def test_questions_without_an_answer_say_so(changes, question, words):
    with pytest.raises(IllPosedError, match=words):
        distributed_lqr(linearize(load_scenario("line", overrides=changes)), **question)
