"""The LQR of the whole formation: known answers, the optimum, and the diagram."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.primitives import Linearize
from scipy.linalg import block_diag, solve_continuous_are, solve_continuous_lyapunov
from strategies import cost, generators

from drake_formation import ScenarioError, build_diagram, load_scenario, set_parameters, simulate
from drake_formation.analysis import IllPosedError, at_rest, certify, linearize
from drake_formation.parts.coordination.centralized_lqr import centralized_gains
from drake_formation.parts.coordination.linear_formation import formation_matrices, spring_matrix
from drake_formation.parts.coordination.state_feedback import feedback_force, tracking_error
from drake_formation.parts.coordination.weights import input_cost, state_cost
from drake_formation.parts.tracking.lqr import lqr_gain
from drake_formation.scenario import resolve

LAW = {"tracking": {"kind": "none"}, "consensus": {"kind": "centralized_lqr"}}
STEEL = {"springs.stiffness": 3e4, "springs.damping": 20.0}
SHORT = {"aggregation.duration": 0.5, "transport.duration": 1.0, "simulator.accuracy": 1e-9}


def scenario(name="quadrilateral", **changes):
    return load_scenario(name, overrides={**LAW, **{k.replace("__", "."): v for k, v in changes.items()}})


def local_gains(formation):
    parts = zip(formation.masses, formation.parts["coordination"], strict=True)
    one = np.eye(4), np.eye(2)
    return block_diag(*(lqr_gain(m, part.config.Q * one[0], part.config.R * one[1]) for m, part in parts))


def mean_cost(a, b, gain, formation):
    """Mean over initial errors of covariance I of what a gain costs."""
    spent = state_cost(formation) + gain.T @ input_cost(formation) @ gain
    return np.trace(solve_continuous_lyapunov((a - b @ gain).T, -spent))


def test_without_springs_it_is_as_many_local_lqrs():
    alike = scenario(springs__stiffness=0.0, robots__mass=[20.0, 40.0, 50.0, 60.0], consensus__Q=[1.0, 2.0, 3.0, 4.0])
    gains = centralized_gains(resolve(alike))
    for gain in (gains.gathering, gains.carrying):
        np.testing.assert_allclose(gain, local_gains(resolve(alike)), atol=1e-9)


@pytest.mark.parametrize("law", ["linear", "hookean"])
def test_springs_are_those_that_the_analysis_linearizes(law):
    changes = {**STEEL, "springs.law": law, "robots.mass": [20.0, 40.0, 50.0, 60.0]}
    expected = linearize(load_scenario("quadrilateral", overrides=changes)).springs
    found = spring_matrix(resolve(scenario(**{k.replace(".", "__"): v for k, v in changes.items()})))
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


@given(st.sampled_from(["linear", "hookean"]), st.floats(0, 1e3), st.floats(0, 50), st.floats(0, 100), generators)
@settings(max_examples=15)
def test_no_decentralized_gain_costs_less(law, stiffness, damping, relative, rng):
    masses = rng.uniform(20, 80, 4).tolist()
    springs = {"law": law, "stiffness": stiffness, "damping": damping}
    formation = resolve(scenario(springs=springs, robots__mass=masses, consensus__relative_cost=relative))
    a, b = formation_matrices(formation.masses)
    a += spring_matrix(formation)
    optimal = mean_cost(a, b, centralized_gains(formation).carrying, formation)
    assert optimal <= mean_cost(a, b, local_gains(formation), formation) * (1 + 1e-9)


@pytest.mark.parametrize("name", ["line", "quadrilateral", "octagon"])
@pytest.mark.parametrize("stiffness", [1.45, 3e4])
def test_it_solves_the_riccati_equation_of_the_whole(name, stiffness):
    formation = resolve(scenario(name, springs__stiffness=stiffness, consensus__relative_cost=10.0))
    a, b = formation_matrices(formation.masses)
    a += spring_matrix(formation)
    riccati = solve_continuous_are(a, b, state_cost(formation), input_cost(formation))
    expected = np.linalg.solve(input_cost(formation), b.T @ riccati)
    np.testing.assert_allclose(centralized_gains(formation).carrying, expected, atol=1e-6 * np.abs(expected).max())


@given(generators)
@settings(max_examples=5)
def test_it_is_optimal_among_its_neighbours(rng):
    formation = resolve(scenario(consensus__Q=cost(rng, 4, False), consensus__R=cost(rng, 2, False)))
    a, b = formation_matrices(formation.masses)
    a += spring_matrix(formation)
    gain = centralized_gains(formation).carrying
    optimal = mean_cost(a, b, gain, formation)
    for _ in range(5):
        assert mean_cost(a, b, gain + rng.uniform(-1, 1, gain.shape) * 1e-2, formation) >= optimal


def test_the_diagram_moves_as_designed():
    steel = scenario(**{k.replace(".", "__"): v for k, v in STEEL.items()}, consensus__relative_cost=20.0)
    diagram, formation = build_diagram(at_rest(steel)), resolve(steel)
    found = Linearize(diagram, diagram.CreateDefaultContext()).A()
    a, b = formation_matrices(formation.masses)
    designed = a + spring_matrix(formation) - b @ centralized_gains(formation).carrying
    np.testing.assert_allclose(found, designed, atol=1e-8)


def test_parameters_design_it_anew_for_each_phase():
    first, second = (scenario(**SHORT_, springs__stiffness=k, consensus__R=r) for k, r in ((1.45, 1.0), (500.0, 0.1)))
    diagram = build_diagram(first)
    context = diagram.CreateDefaultContext()
    set_parameters(diagram, context, second)
    rebuilt = build_diagram(second)
    fresh = rebuilt.CreateDefaultContext()
    for phase in (0.0, 1.0):
        for one, its in ((diagram, context), (rebuilt, fresh)):
            one.GetSubsystemByName("phase").GetMyMutableContextFromRoot(its).SetDiscreteState([phase])
        ports = [
            (one.GetOutputPort("robot_2_consensus_force"), its) for one, its in ((diagram, context), (rebuilt, fresh))
        ]
        changed, expected = (port.Eval(its) for port, its in ports)
        np.testing.assert_array_equal(changed, expected)
        state = fresh.get_continuous_state_vector().CopyToVector().reshape(-1, 4)
        formation = resolve(second)
        gains = centralized_gains(formation)
        centre = formation.goal if phase else formation.centre
        errors = state - np.hstack([formation.slots + centre, np.zeros((4, 2))])
        forces = -(gains.carrying if phase else gains.gathering) @ errors.ravel()
        np.testing.assert_allclose(changed, forces[2:4], rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    short = scenario(**SHORT_, consensus__relative_cost=5.0)
    blocks, other = (simulate(short, engine=name) for name in ("blocks", engine))
    np.testing.assert_allclose(other["position"][-1], blocks["position"][-1], atol=1e-6)
    assert float(abs(blocks["velocity"][-1]).max()) > 0.1


SHORT_ = {k.replace(".", "__"): v for k, v in SHORT.items()}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"consensus__graph": "cycle"}, r"consensus\.graph: robot 1 does not hear robot 3, and its force depends on"),
        (
            {"tracking": {"kind": "lqr"}},
            r"tracking\.kind: 'centralized_lqr' is the whole control and takes no account",
        ),
        ({"consensus__kind": {"2": "consensus", "default": "centralized_lqr"}}, "robot 2 coordinates by 'consensus'"),
        ({"consensus__relative_cost": -1.0}, r"consensus\.relative_cost: not positive semi-definite"),
        ({"consensus__relative_cost": [1.0, 0.0]}, r"consensus\.relative_cost: a diagonal of 2 entries"),
        ({"consensus__relative_cost": {"1": 1.0, "default": 2.0}}, "robots have different ones"),
        ({"consensus__Q": 0.0}, r"consensus\.Q: a position costs nothing"),
        ({"consensus__R": {"2": -1.0, "default": 1.0}}, r"consensus\.R.*not positive definite"),
        ({"consensus__R": 1e-300}, "Drake finds no stabilizing gain"),
    ],
)
def test_what_has_no_optimum_is_refused(changes, words):
    with pytest.raises(ScenarioError, match=words):
        resolve(scenario(**changes))


def test_what_is_certified_is_another_law():
    with pytest.raises(IllPosedError, match="robot 1 coordinates by 'centralized_lqr'"):
        certify(scenario())


@given(generators)
def test_its_law_is_the_gain_times_the_errors(rng):
    states, slots, centre, gain = (rng.uniform(-5, 5, shape) for shape in ((3, 4), (3, 2), 4, (2, 12)))
    errors = [tracking_error(*one) for one in zip(states.tolist(), [centre.tolist()] * 3, slots.tolist(), strict=True)]
    expected = (states - centre - np.hstack([slots, np.zeros((3, 2))])).ravel()
    np.testing.assert_allclose(np.ravel(errors), expected, atol=1e-12)
    np.testing.assert_allclose(feedback_force(expected.tolist(), gain.ravel().tolist()), -gain @ expected, atol=1e-9)


def test_an_engine_is_chosen_for_it_too():
    assert simulate(scenario(**SHORT_, springs__stiffness=0.0)).attrs["engine"] == "blocks"
