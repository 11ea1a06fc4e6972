"""The bound on forces: never below what motions reach, hardly above it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm
from strategies import generators, scenarios

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.control_gains import control_gains
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.response.peak_norm import energy, require_stable, supremum
from drake_formation.analysis.response.worst_case_force import displacements
from drake_formation.scenario import resolve


def worst(formation, radii, **options):
    outputs = control_gains(formation).at(formation.delta, formation.delta_v)
    start = displacements(formation.robots)
    return supremum(formation, formation.delta, formation.delta_v, outputs, start, radii, **options), outputs, start


@given(scenario=scenarios(robots=st.integers(1, 4)), rng=generators)
@settings(max_examples=15, deadline=None)
def test_no_motion_exceeds_the_bound_and_one_attains_the_value(scenario, rng):
    formation = linearize(scenario)
    radii = rng.uniform(0, 1, formation.robots + 1)
    found, outputs, start = worst(formation, radii)
    attained = outputs @ expm(formation.A * found.time) @ start @ found.weights.ravel()
    assert np.linalg.norm(attained.reshape(-1, 2)[found.robot]) == pytest.approx(found.value, rel=1e-6, abs=1e-12)
    assert np.all(np.linalg.norm(found.weights, axis=1) <= radii * (1 + 1e-12))
    assert found.value <= found.bound <= found.value * 1.01

    step = expm(formation.A * 0.1 / np.abs(np.linalg.eigvals(formation.A)).max())
    angles = rng.uniform(0, 2 * np.pi, (formation.robots + 1, 40))
    errors = radii[:, None, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    state = np.einsum("xbk,bsk->xs", start.reshape(len(start), -1, 2), errors)
    for _ in range(200):
        forces = np.linalg.norm((outputs @ state).reshape(-1, 2, 40), axis=1)
        assert forces.max() <= found.bound
        state = step @ state


@given(scenario=scenarios(isotropic=True))
@settings(max_examples=15, deadline=None)
def test_the_energy_of_symmetric_loops_is_mechanical(scenario):
    formation = linearize(scenario)
    matrix = energy(formation, formation.A)
    mass = np.repeat(resolve(scenario).masses, 2)
    positions = np.arange(len(matrix)).reshape(-1, 4)[:, :2].ravel()
    rates = positions + 2
    stiffness = -mass[:, None] * formation.A[np.ix_(rates, positions)]
    scale = np.abs(matrix).max()
    np.testing.assert_allclose(matrix[np.ix_(rates, rates)], np.diag(mass), atol=1e-6 * scale)
    np.testing.assert_allclose(matrix[np.ix_(positions, positions)], stiffness, atol=1e-6 * scale)


@given(scenario=scenarios())
@settings(max_examples=15, deadline=None)
def test_no_energy_grows(scenario):
    formation = linearize(scenario)
    matrix = energy(formation, formation.A)
    change = formation.A.T @ matrix + matrix @ formation.A
    assert np.linalg.eigvalsh(matrix)[0] > 0
    assert np.linalg.eigvalsh(change)[-1] <= 1e-7 * np.abs(change).max()


def test_one_robot_peaks_at_once():
    formation = linearize(
        load_scenario(
            "line",
            overrides={"formation": {"shape": "slots", "slots": [[0, 0]]}, "robots.start": {"centre": [2.5, 3.5]}},
        )
    )
    found, _, _ = worst(formation, np.array([0.0, 22.5]))
    assert found.value == pytest.approx(22.5)  # published: K_l times 22.5 m
    assert found.time == 0


def test_it_scales_with_the_errors_and_adds_no_more_than_they_do():
    formation = linearize(load_scenario("quadrilateral", overrides={"consensus.delta": 100.0}))
    one, _, _ = worst(formation, np.array([0.1, 0.1, 0.1, 0.1, 0.0]))
    ten, _, _ = worst(formation, np.array([1.0, 1.0, 1.0, 1.0, 0.0]))
    travel, _, _ = worst(formation, np.array([0.0, 0.0, 0.0, 0.0, 5.0]))
    both, _, _ = worst(formation, np.array([1.0, 1.0, 1.0, 1.0, 5.0]))
    assert ten.value == pytest.approx(10 * one.value)
    assert max(ten.value, travel.value) <= both.value <= ten.bound + travel.bound


def test_nothing_pushed_nothing_pushes():
    found, _, _ = worst(linearize(load_scenario("line")), np.zeros(3))
    assert (found.value, found.bound) == (0.0, 0.0)


def test_more_than_enough_is_not_looked_into():
    formation = linearize(load_scenario("line", overrides={"consensus.delta": 1e4}))
    found, _, _ = worst(formation, np.array([0.01, 0.01, 0.0]), enough=10.0)
    assert found.value > 10
    assert found.bound == np.inf


def test_an_unstable_loop_has_no_peak():
    with pytest.raises(IllPosedError, match="unstable"):
        require_stable(np.diag([-1.0, 0.1]), 1.0, 2.0)


def test_stiff_loops_are_followed_in_growing_steps():
    """Relative modes at 500 1/s beside a centre at 0.11 1/s; the first force is δ alone, the last ones are slow."""
    formation = linearize(load_scenario("line", overrides={"consensus.delta": 1e3, "consensus.delta_v": 1e4}))
    found, _, _ = worst(formation, np.array([0.01, 0.01, 22.5]))
    assert found.value == pytest.approx((2 * 1e3 + 1) * 0.01 + 22.5)
    assert found.bound <= found.value * 1.01


@pytest.mark.filterwarnings("ignore:Input .a. has an eigenvalue pair:RuntimeWarning")
@pytest.mark.parametrize("delta_v", [1e8, 1e12])
def test_a_loop_too_stiff_to_follow_says_so(delta_v):
    formation = linearize(load_scenario("line", overrides={"consensus.delta": 1e3, "consensus.delta_v": delta_v}))
    with pytest.raises(IllPosedError, match="smaller δ or δ_v"):
        worst(formation, np.array([0.01, 0.01, 1.0]))
