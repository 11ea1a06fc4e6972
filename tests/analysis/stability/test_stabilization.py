"""Remedies of an unstable loop: each one makes the actual diagram stable."""

import numpy as np
import pytest
from hypothesis import given, settings
from pydrake.systems.analysis import Simulator
from strategies import scenarios
from unstable import UNSTABLE

from drake_formation import build_diagram, load_scenario, with_overrides
from drake_formation.analysis.linear.linearization import linearize
from drake_formation.analysis.stability.modes import modes
from drake_formation.analysis.stability.stabilization import cause, remedies
from drake_formation.parts.tracking.costs import cost_matrix


def growth(scenario, seconds=8.0):
    """By what factor a small deviation of the scenario's diagram, at rest at its goal, has grown in simulation."""
    diagram = build_diagram(linearize(scenario).scenario)
    simulator = Simulator(diagram)
    state = simulator.get_mutable_context().get_mutable_continuous_state_vector()
    rest = state.CopyToVector()
    deviation = 1e-6 * np.random.default_rng(0).normal(size=len(rest))
    state.SetFromVector(rest + deviation)
    simulator.get_mutable_integrator().set_target_accuracy(1e-10)
    simulator.AdvanceTo(seconds)
    moved = simulator.get_context().get_continuous_state_vector().CopyToVector() - rest
    return np.linalg.norm(moved[[0, 1, 4, 5]]) / np.linalg.norm(deviation)


def test_an_unstable_line_grows_in_simulation_until_a_remedy_is_taken():
    scenario = load_scenario("line", overrides=UNSTABLE)
    assert not modes(linearize(scenario)).stable
    assert growth(scenario) > 10
    found = remedies(linearize(scenario))
    assert [sorted(remedy.overrides) for remedy in found] == [["tracking.Q", "tracking.R"], ["consensus.delta_v"]]
    for remedy in found:
        mended = with_overrides(scenario, remedy.overrides)
        slowest = modes(linearize(mended)).slowest[0]
        assert slowest.decay_rate == pytest.approx(remedy.decay_rate, rel=1e-3)
        assert growth(mended) < 10


def test_the_cause_names_the_springs():
    sentence = cause(linearize(load_scenario("line", overrides=UNSTABLE)))
    assert sentence.endswith("it takes the object's springs to destabilize them")


def test_a_remedy_reads_as_it_is_typed():
    found = remedies(linearize(load_scenario("line", overrides=UNSTABLE)))
    assert str(found[0]).startswith("--set tracking.Q=[1.0,1.0,10000.0,1.0] --set tracking.R=[1.0,1.0] ")
    typed = [text for text in str(found[0]).split(" (")[0].split("--set ") if text]
    again = load_scenario("line", overrides=[text.strip() for text in typed])
    assert again.tracking == with_overrides(load_scenario("line"), found[0].overrides).tracking


@given(scenario=scenarios())
@settings(max_examples=25)
def test_diagonal_weights_are_stable_whatever_the_rest(scenario):
    q, r = cost_matrix(scenario.tracking.Q, 4), cost_matrix(scenario.tracking.R, 2)
    weights = {"tracking.Q": np.diag(q).tolist(), "tracking.R": np.diag(r).tolist()}
    assert modes(linearize(with_overrides(scenario, weights))).stable
