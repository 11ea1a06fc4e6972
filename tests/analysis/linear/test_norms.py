"""H2 and H∞ norms: known resonances, dense grids, laws of both."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.linalg import expm
from strategies import generators

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.norms import (
    ResonancePeak,
    StateSpace,
    frequency_response,
    gains,
    h2_norm,
    hinf_norm,
    steady_covariance,
)
from drake_formation.analysis.response.disturbance import force_to_error

frequencies = st.floats(0.1, 100)
light = st.floats(1e-4, 0.65)


def oscillator(frequency, damping):
    """x'' + 2 ζ ω x' + ω² x = w, y = x."""
    A = np.array([[0.0, 1.0], [-(frequency**2), -2 * damping * frequency]])
    return StateSpace(A, np.array([[0.0], [1.0]]), np.array([[1.0, 0.0]]))


def random_system(rng, states=6, inputs=2, outputs=3):
    A = rng.normal(size=(states, states))
    A -= (np.linalg.eigvals(A).real.max() + rng.uniform(0.02, 1)) * np.eye(states)
    return StateSpace(A, rng.normal(size=(states, inputs)), rng.normal(size=(outputs, states)))


@given(frequency=frequencies, damping=light)
def test_resonance_of_an_oscillator(frequency, damping):
    peak = hinf_norm(oscillator(frequency, damping))
    np.testing.assert_allclose(peak.gain, 1 / (2 * damping * np.sqrt(1 - damping**2) * frequency**2), rtol=2e-6)
    # The gain is flat at its peak: the frequency is known to the root of the tolerance.
    np.testing.assert_allclose(peak.frequency, frequency * np.sqrt(1 - 2 * damping**2), rtol=5e-3)


@given(frequency=frequencies, damping=st.floats(0.75, 5))
def test_a_damped_oscillator_gives_way_most_at_rest(frequency, damping):
    peak = hinf_norm(oscillator(frequency, damping))
    np.testing.assert_allclose(peak.gain, frequency**-2, rtol=2e-6)


@given(frequency=frequencies, damping=st.floats(1e-3, 5))
def test_h2_norm_of_an_oscillator(frequency, damping):
    expected = (4 * damping * frequency**3) ** -0.5
    np.testing.assert_allclose(h2_norm(oscillator(frequency, damping)), expected, rtol=1e-6)


@pytest.mark.parametrize(
    ("graph", "known"),
    [(nx.path_graph(10), 8.25), (nx.cycle_graph(10), 4.125), (nx.complete_graph(10), 0.45)],
    ids=["path", "ring", "complete"],
)
def test_noisy_consensus_of_single_integrators(graph, known):
    """Σ 1/(2 λ) about the mean, which wanders off and does not matter (Bamieh, Jovanović, Mitra and Patterson 2012)."""
    agreement = StateSpace(-nx.laplacian_matrix(graph).toarray(), np.eye(10), np.eye(10) - np.ones((10, 10)) / 10)
    assert h2_norm(agreement) ** 2 == pytest.approx(known, abs=5e-7)
    with pytest.raises(IllPosedError, match="not asymptotically stable"):
        h2_norm(agreement._replace(C=np.eye(10)))


@given(rng=generators)
def test_no_gain_of_a_dense_grid_exceeds_the_norm(rng):
    system = random_system(rng)
    peak = hinf_norm(system)
    grid = np.concatenate([np.linspace(0, 20, 2001), peak.frequency * np.linspace(0.9, 1.1, 401)])
    values = gains(frequency_response(system, grid))
    assert values.max() <= peak.gain * (1 + 1e-6)
    assert values.max() >= peak.gain * (1 - 1e-4)


@given(rng=generators)
def test_norms_of_the_transpose_are_the_same(rng):
    system = random_system(rng)
    dual = StateSpace(system.A.T, system.C.T, system.B.T)
    np.testing.assert_allclose(hinf_norm(dual).gain, hinf_norm(system).gain, rtol=3e-6)
    np.testing.assert_allclose(h2_norm(dual), h2_norm(system), rtol=1e-7)


@given(rng=generators)
def test_worst_of_two_systems_in_one_pass(rng):
    one, other = random_system(rng), random_system(rng)
    first, second = hinf_norm(one), hinf_norm(other)
    assume(abs(first.gain - second.gain) > 1e-3 * first.gain)
    expected = max(first, second, key=lambda peak: peak.gain)
    np.testing.assert_allclose(hinf_norm(other, start=first).gain, expected.gain, rtol=3e-6)


def test_a_start_that_no_frequency_reaches_is_kept():
    start = ResonancePeak(1e3, 7.0)
    assert hinf_norm(oscillator(1.0, 0.5), start=start) is start


def test_covariance_is_the_integral_of_the_impulse_response():
    system = random_system(np.random.default_rng(3))
    step, time = 1e-3, 0.0
    forward, state = expm(system.A * step), expm(system.A * step / 2) @ system.B
    total = np.zeros_like(system.A)
    while time < 400.0 and np.abs(state).max() > 1e-9:
        total += step * state @ state.T
        state, time = forward @ state, time + step
    covariance = steady_covariance(system.A, system.B @ system.B.T)
    np.testing.assert_allclose(covariance, total, atol=1e-5 * np.abs(total).max())


@pytest.mark.parametrize(("name", "robots"), [("line", 2), ("quadrilateral", 4), ("octagon", 8)])
def test_relative_modes_of_the_paper(name, robots):
    """On a complete graph all relative modes are m s² + 9 s + 1 + Nδ, where soft springs hardly count."""
    overrides = {"consensus.delta": 2e4, "springs.stiffness": 0.0}
    peak = hinf_norm(force_to_error(linearize(load_scenario(name, overrides=overrides)), 2e4, 0.0))
    stiffness = 1 + robots * 2e4
    frequency, damping = np.sqrt(stiffness / 40), 9 / (2 * np.sqrt(40 * stiffness))
    expected = 1 / (2 * damping * np.sqrt(1 - damping**2) * stiffness)
    np.testing.assert_allclose(peak.gain, expected, rtol=1e-5)
    np.testing.assert_allclose(peak.frequency, frequency, rtol=1e-4)


@pytest.mark.parametrize("norm", [h2_norm, hinf_norm])
def test_an_unstable_system_has_no_norm(norm):
    with pytest.raises(IllPosedError, match="not asymptotically stable"):
        norm(oscillator(1.0, -0.1))
