"""Modes: all eigenvalues and no others, the textbook's formulas, and what a simulation of the diagram shows."""

import numpy as np
import pytest
from hypothesis import given, settings
from pydrake.systems.analysis import Simulator
from strategies import scenarios

from drake_formation import build_diagram, load_scenario
from drake_formation.analysis.linear.linearization import linearize
from drake_formation.analysis.linear.motion_subspaces import parts
from drake_formation.analysis.stability.modes import decay_limit, modes, movable

STEEL = {"springs.stiffness": 3e4, "consensus.delta": 1e4}


def modes_of(name, **overrides):
    return modes(linearize(load_scenario(name, overrides=overrides)))


def listed(found):
    """Every eigenvalue of a table of modes, conjugates too."""
    values = []
    for mode in found.modes:
        pair = [mode.eigenvalue, mode.eigenvalue.conjugate()] if mode.eigenvalue.imag else [mode.eigenvalue]
        values += pair * mode.count
    return np.array(values)


def same(ours, theirs, tolerance):
    """Whether two lists hold the same eigenvalues in any order."""
    from scipy.optimize import linear_sum_assignment

    distances = np.abs(ours[:, None] - theirs[None, :])
    return len(ours) == len(theirs) and distances[linear_sum_assignment(distances)].max() <= tolerance


@given(scenario=scenarios())
@settings(max_examples=25)
def test_modes_are_the_full_eigenvalues(scenario):
    formation = linearize(scenario)
    found = modes(formation)
    full = np.linalg.eigvals(formation.A)
    assert same(listed(found), full, 1e-5 * np.abs(full).max())
    assert found.stable == (full.real.max() < 0)
    for mode in found.modes:
        assert sum(mode.shares.values()) == pytest.approx(1)
        assert mode.robots.sum() == pytest.approx(1)


@pytest.mark.parametrize("graph", ["complete", "cycle", "path", "star"])
@pytest.mark.parametrize("law", ["linear", "hookean"])
def test_decoupled_modes_are_the_full_eigenvalues(graph, law):
    formation = linearize(
        load_scenario("octagon", overrides={**STEEL, "consensus.graph": graph, "springs.law": law, "springs.graph": []})
    )
    found = modes(formation)
    assert all(mode.decoupled for mode in found.modes)
    # Double roots come in pairs split by rounding, to √eps; these are semi-simple and agree better.
    assert same(listed(found), np.linalg.eigvals(formation.A), 1e-7)


@pytest.mark.parametrize("graph", ["complete", "cycle", "path", "star"])
def test_each_laplacian_eigenvalue_has_its_own_oscillator(graph):
    """Without springs: m s² + (d + δ_v λ) s + p + δ λ = 0, twice for every λ."""
    delta, delta_v = 30.0, 5.0
    formation = linearize(
        load_scenario(
            "octagon",
            overrides={"springs.graph": [], "consensus": {"graph": graph, "delta": delta, "delta_v": delta_v}},
        )
    )
    expected = [np.roots([40, 9 + delta_v * lam, 1 + delta * lam]) for lam in np.linalg.eigvalsh(formation.laplacian)]
    found = modes(formation)
    assert same(listed(found), np.repeat(np.concatenate(expected), 2), 1e-6)
    for mode in found.modes:
        root = np.roots([40, 9 + delta_v * mode.laplacian_eigenvalue, 1 + delta * mode.laplacian_eigenvalue])
        assert np.abs(root - mode.eigenvalue).min() < 1e-6


def test_the_papers_line_in_steel():
    centre, rotation, stretch = modes_of("line", **STEEL).modes
    assert [mode.kind for mode in (centre, rotation, stretch)] == ["centre", "rotation", "stretch"]
    assert [mode.count for mode in (centre, rotation, stretch)] == [2, 1, 1]
    assert not centre.moved_by_consensus
    assert rotation.moved_by_consensus
    # Steel stiffens stretch by 2k and leaves the rotation to consensus alone.
    assert abs(rotation.eigenvalue) ** 2 == pytest.approx((1 + 2e4) / 40)
    assert abs(stretch.eigenvalue) ** 2 == pytest.approx((1 + 2e4 + 6e4) / 40)
    assert rotation.settling_time == pytest.approx(np.log(50) * 80 / 9)


@pytest.mark.parametrize("stiffness", [1.45, 3e4])
@pytest.mark.parametrize("delta", [0.0, 1e4, 2e4])
@pytest.mark.parametrize("name", ["line", "quadrilateral", "octagon"])
def test_without_damping_relative_modes_decay_at_d_over_2m_whatever_delta(name, delta, stiffness):
    found = modes_of(name, **{"consensus.delta": delta, "springs.stiffness": stiffness})
    assert found.decay_limit == pytest.approx(9 / 80, rel=1e-9)
    for mode in found.modes:
        assert mode.decay_rate == pytest.approx(9 / 80, rel=1e-6)


def test_damping_raises_the_decay_of_relative_modes_alone():
    still = modes_of("quadrilateral", **{"consensus.delta": 1e4, "consensus.delta_v": 100.0})
    for mode in still.modes:
        expected = 9 / 80 if mode.kind == "centre" else (9 + 4 * 100) / 80
        assert mode.decay_rate == pytest.approx(expected, rel=1e-6)
    assert still.decay_limit == pytest.approx((9 + 400) / 80)
    assert [mode.kind for mode in still.slowest] == ["centre"]


@given(scenario=scenarios())
@settings(max_examples=15)
def test_no_gain_beats_the_decay_limit(scenario):
    formation = linearize(scenario)
    space, limit = movable(formation), decay_limit(formation)
    if limit is None:
        assert formation.robots == 1
        return
    for delta in (0.0, 1.0, 100.0, 1e4):
        values = np.linalg.eigvals(space.T @ formation.closed_loop(delta, formation.delta_v) @ space)
        assert -values.real.max() <= limit * (1 + 1e-6) + 1e-9


@given(scenario=scenarios(homogeneous=True))
@settings(max_examples=15)
def test_what_consensus_cannot_move_is_the_centre_of_identical_robots(scenario):
    formation = linearize(scenario)
    assert movable(formation).shape[1] == 4 * (formation.robots - 1)
    for mode in modes(formation).modes:
        assert mode.moved_by_consensus == (mode.shares["centre"] < 0.5)


def test_consensus_moves_every_mode_of_unlike_robots():
    formation = linearize(load_scenario("line", overrides={"robots.mass": [20.0, 50.0]}))
    assert movable(formation).shape[1] == 8
    assert all(mode.moved_by_consensus for mode in modes(formation).modes)


def test_coupled_laplacian_spaces_carry_a_mean_and_participation():
    found = modes_of("quadrilateral", **{"consensus.graph": "path", "robots.mass": [10.0, 40.0, 40.0, 40.0], **STEEL})
    assert not any(mode.decoupled for mode in found.modes)
    largest = found.laplacian_eigenvalues[-1]
    assert all(0 <= mode.laplacian_eigenvalue <= largest + 1e-9 for mode in found.modes)
    assert max(mode.robots[0] for mode in found.modes) > 0.5  # the light robot has a mode much to itself


def test_a_critically_damped_loop_is_one_double_root():
    """Q chosen so that d² = 4 m p: the double root comes out once, with both its copies."""
    found = modes_of("line", **{"tracking.Q": [1.0, 1.0, 80.0, 80.0], "springs.graph": []})
    (mode,) = [mode for mode in found.modes if mode.kind == "centre"]
    assert mode.count == 4
    assert mode.eigenvalue == pytest.approx(-np.sqrt(1 / 40), rel=1e-5)
    assert mode.damping_ratio == pytest.approx(1)


def started_along(scenario, direction, size):
    """The diagram of a linearized scenario, displaced from rest along a direction of all robots' positions."""
    diagram = build_diagram(scenario)
    simulator = Simulator(diagram)
    state = simulator.get_mutable_context().get_mutable_continuous_state_vector()
    rest = state.CopyToVector().reshape(-1, 4)
    moved = rest.copy()
    moved[:, :2] += size * direction.reshape(-1, 2)
    state.SetFromVector(moved.ravel())
    simulator.get_mutable_integrator().set_target_accuracy(1e-10)
    return simulator, rest


@pytest.mark.parametrize("kind", ["centre", "rotation", "stretch"])
@pytest.mark.parametrize("delta", [0.0, 20.0])
def test_a_simulated_mode_oscillates_and_decays_as_the_table_says(kind, delta):
    """Logarithmic decrement and zero crossings of the actual nonlinear diagram, by each mode of the steel line."""
    formation = linearize(load_scenario("line", overrides={"springs.stiffness": 100.0, "consensus.delta": delta}))
    direction = parts(formation)[kind][:, 0]
    mode = next(mode for mode in modes(formation).modes if mode.shares[kind] > 0.99)
    simulator, rest = started_along(formation.scenario, direction, 1e-4)
    times = np.linspace(0, 4 * np.pi / mode.frequency, 401)
    amplitude, rate = [], []
    for time in times:
        simulator.AdvanceTo(time)
        state = simulator.get_context().get_continuous_state_vector().CopyToVector().reshape(-1, 4) - rest
        amplitude.append(state[:, :2].ravel() @ direction)
        rate.append(state[:, 2:].ravel() @ direction)
    # Two samples of (q, q̇) one period apart differ by the factor exp(−decay · period), whatever the phase.
    period = 200
    ratio = np.array(amplitude[period:]) @ np.array(amplitude[:-period]) / np.sum(np.square(amplitude[:-period]))
    assert -np.log(ratio) / times[period] == pytest.approx(mode.decay_rate, rel=1e-3)
    crossings = np.flatnonzero(np.diff(np.sign(amplitude)))
    assert len(crossings) == 4


def test_steel_leaves_the_rotation_free_in_simulation():
    """A steel square turned by 0.01 rad feels no spring; under the paper's Eq. 5 the springs shake it."""
    for law, felt in (("hookean", False), ("linear", True)):
        formation = linearize(load_scenario("quadrilateral", overrides={"springs.stiffness": 3e4, "springs.law": law}))
        direction = parts(formation)["rotation"][:, 0]
        simulator, _ = started_along(formation.scenario, direction, 1e-3)
        diagram = simulator.get_system()
        forces = [
            np.abs(diagram.GetOutputPort(f"robot_{i}_spring_force").Eval(simulator.get_context())).max()
            for i in range(1, 5)
        ]
        assert (max(forces) > 1.0) == felt  # 3e4 N/m times what a rotation stretches, of second order
        mode = next(mode for mode in modes(formation).modes if mode.shares["rotation"] > 0.01)
        stiffness = abs(mode.eigenvalue) ** 2 * 40
        assert stiffness == pytest.approx(1.0 if not felt else 1.0 + 4 * 3e4, rel=1e-6)
