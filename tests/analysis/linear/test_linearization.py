"""The linearized diagram: its parts add up to the whole, and the laws it must obey."""

import numpy as np
import pytest
from hypothesis import given, settings
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import InputPortSelection, OutputPortSelection
from pydrake.systems.primitives import Linearize
from strategies import scenarios

from drake_formation import build_diagram, load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.linearization import at_rest, own
from drake_formation.scenario import resolve


@given(scenario=scenarios())
@settings(max_examples=15, deadline=None)
def test_parts_add_up_to_the_whole_diagram(scenario):
    formation = linearize(scenario)
    diagram = build_diagram(formation.scenario)
    whole = Linearize(
        diagram, diagram.CreateDefaultContext(), InputPortSelection.kNoInput, OutputPortSelection.kNoOutput
    ).A()
    np.testing.assert_allclose(formation.A, whole, rtol=1e-9, atol=1e-9 * np.abs(whole).max())


@given(scenario=scenarios())
@settings(max_examples=15, deadline=None)
def test_consensus_and_springs_leave_a_translation_alone(scenario):
    formation = linearize(scenario)
    together = np.kron(np.ones(formation.robots), np.array([0.3, -0.7, 0.2, 0.9]))
    for part in (formation.springs, formation.per_delta, formation.per_delta_v):
        np.testing.assert_allclose(part @ together, 0, atol=1e-9 * max(1.0, np.abs(part).max()))


def test_consensus_is_the_laplacian_over_the_masses():
    formation = linearize(load_scenario("quadrilateral", overrides={"robots.mass": [10.0, 20.0, 30.0, 40.0]}))
    expected = -formation.laplacian / resolve(formation.scenario).masses[:, None]
    onto_velocity = np.kron(expected, np.eye(2))
    rows = np.arange(16).reshape(4, 4)[:, 2:].ravel()
    positions = np.arange(16).reshape(4, 4)[:, :2].ravel()
    np.testing.assert_allclose(formation.per_delta[np.ix_(rows, positions)], onto_velocity, atol=1e-12)
    np.testing.assert_allclose(formation.per_delta_v[np.ix_(rows, rows)], onto_velocity, atol=1e-12)
    assert np.count_nonzero(formation.per_delta) + np.count_nonzero(formation.per_delta_v) == 2 * 32


def test_a_force_accelerates_its_own_robot_by_its_mass():
    formation = linearize(load_scenario("line", overrides={"robots.mass": [20.0, 50.0]}))
    expected = np.zeros((8, 4))
    expected[2:4, :2], expected[6:8, 2:] = np.eye(2) / 20, np.eye(2) / 50
    np.testing.assert_allclose(formation.B, expected, atol=1e-15)


def test_own_and_neighbours_split_the_laplacian():
    formation = linearize(load_scenario("octagon"))
    consensus = formation.consensus(2.0, 3.0)
    neighbours = consensus - own(consensus)
    assert np.all(own(consensus) <= 0)
    assert np.all(neighbours >= 0)
    np.testing.assert_allclose(own(neighbours), 0)


@pytest.mark.parametrize("name", ["line", "s_curve", "octagon"])
def test_small_deviations_move_as_the_diagram_does(name):
    formation = linearize(load_scenario(name, overrides={"consensus.delta": 50.0, "springs.stiffness": 200.0}))
    diagram = build_diagram(formation.scenario)
    simulator = Simulator(diagram)
    state = simulator.get_mutable_context().get_mutable_continuous_state_vector()
    rest = state.CopyToVector()
    deviation = 1e-6 * np.random.default_rng(1).normal(size=len(rest))
    state.SetFromVector(rest + deviation)
    simulator.get_mutable_integrator().set_target_accuracy(1e-12)
    simulator.AdvanceTo(2.0)
    values, vectors = np.linalg.eig(formation.A)
    expected = (vectors @ (np.exp(2.0 * values) * np.linalg.solve(vectors, deviation))).real
    moved = simulator.get_context().get_continuous_state_vector().CopyToVector() - rest
    np.testing.assert_allclose(moved, expected, atol=1e-4 * np.abs(expected).max())


def test_start_phases_reference_and_obstacles_play_no_part():
    plain = load_scenario("line")
    other = load_scenario(
        "line", overrides={"aggregation.duration": 0, "transport.reference": {"kind": "minimum_jerk"}}
    )
    assert at_rest(plain).avoidance.obstacles == ()
    np.testing.assert_array_equal(linearize(plain).A, linearize(other).A)


def test_robots_that_do_not_all_talk_are_linearized_too():
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus": {"graph": [[1, 2]], "delta": 0.0}}))
    rows, positions = np.arange(16).reshape(4, 4)[:, 2:].ravel(), np.arange(16).reshape(4, 4)[:, :2].ravel()
    expected = np.kron(-formation.laplacian / 40, np.eye(2))
    np.testing.assert_allclose(formation.per_delta[np.ix_(rows, positions)], expected, atol=1e-12)
