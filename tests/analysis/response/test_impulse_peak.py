"""The bound on impulse responses: known peaks, dense samples, and every force of some total impulse."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag, expm
from strategies import generators, scenarios

from drake_formation.analysis import linearize
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.norms import StateSpace
from drake_formation.analysis.response.disturbance import error_outputs, force_to_error
from drake_formation.analysis.response.impulse_peak import block_norms, impulse_peaks

TOLERANCE = 1e-3


def oscillators(*pairs):
    """One oscillator for x and one for y: (ω, ζ) each."""
    blocks = [np.array([[0.0, 1.0], [-(w**2), -2 * z * w]]) for w, z in pairs]
    inputs, outputs = np.array([[0.0], [1.0]]), np.array([[1.0, 0.0]])
    return StateSpace(block_diag(*blocks), block_diag(inputs, inputs), block_diag(outputs, outputs))


def peak_of(frequency, damping):
    """Largest impulse response of an oscillator, and when."""
    if damping < 1:
        damped = frequency * np.sqrt(1 - damping**2)
        time = np.arctan2(np.sqrt(1 - damping**2), damping) / damped
        return np.exp(-damping * frequency * time) * np.sin(damped * time) / damped, time
    root = frequency * np.sqrt(damping**2 - 1)
    time = np.arctanh(root / (damping * frequency)) / root
    return np.exp(-damping * frequency * time) * np.sinh(root * time) / root, time


@given(frequency=st.floats(0.1, 50), ratio=st.floats(1.05, 5), damping=st.floats(1e-2, 0.98) | st.floats(1.02, 5))
@settings(max_examples=50)
def test_peak_of_an_oscillator(frequency, ratio, damping):
    peaks = impulse_peaks(oscillators((frequency, damping), (frequency * ratio, damping)))
    value, time = peak_of(frequency, damping)
    assert value * (1 - 1e-9) <= peaks.bound[0] <= value * (1 + TOLERANCE + 1e-9)
    np.testing.assert_allclose(peaks.time[0], time, rtol=0.1)


@given(rng=generators)
def test_no_sample_exceeds_the_bound(rng):
    A = rng.normal(size=(8, 8)) * 3
    A -= (np.linalg.eigvals(A).real.max() + rng.uniform(0.05, 2)) * np.eye(8)
    system = StateSpace(A, rng.normal(size=(8, 4)), rng.normal(size=(6, 8)))
    peaks = impulse_peaks(system)
    samples = [system.C @ system.B]
    state, step = system.B, expm(A * 0.003)
    for _ in range(2000):
        state = step @ state
        samples.append(system.C @ state)
    largest = block_norms(np.array(samples)).max(axis=(0, 1))
    assert np.all(largest <= peaks.bound * (1 + 1e-9))
    assert np.all(peaks.reached * (1 + TOLERANCE) <= peaks.bound * (1 + 1e-12))
    assert np.all(largest >= 0.99 * peaks.reached)


@given(rng=generators, size=st.tuples(st.integers(1, 3), st.integers(1, 3)))
def test_block_norms_are_the_spectral_norms(rng, size):
    matrix = rng.normal(size=(2 * size[0], 2 * size[1]))
    expected = [[np.linalg.norm(matrix[2 * i : 2 * i + 2, 2 * j : 2 * j + 2], 2) for j in range(size[1])]
                for i in range(size[0])]  # fmt: skip
    np.testing.assert_allclose(block_norms(matrix), expected, rtol=1e-12)


@given(scenario=scenarios(robots=st.integers(2, 4)), rng=generators)
@settings(max_examples=25)
def test_every_force_of_an_impulse_stays_under_the_bound(scenario, rng):
    """Any force is a train of blows; none of the trains tried moves any robot by more than its impulse allows."""
    formation = linearize(scenario)
    system = force_to_error(formation, formation.delta, formation.delta_v)
    step = expm(system.A * 0.05)
    forces = rng.normal(size=(80, 2 * formation.robots)) * (rng.random((80, 1)) < 0.3)
    impulses = np.linalg.norm(forces.reshape(80, -1, 2), axis=-1).sum(axis=0)
    state, largest = np.zeros(len(system.A)), 0.0
    for force in forces:
        state = step @ (state + system.B @ force)
        largest = max(largest, np.linalg.norm((system.C @ state).reshape(-1, 2), axis=1).max())
    assert largest <= impulse_peaks(system).bound @ impulses


def test_when_and_where_the_peak_is():
    """Two formations that know nothing of each other: each feels its own blow."""
    system = oscillators((2.0, 0.1), (2.0, 0.1))
    both = StateSpace(
        block_diag(system.A, system.A), block_diag(system.B, system.B), block_diag(system.C, 3 * system.C)
    )
    peaks = impulse_peaks(both)
    assert peaks.robot.tolist() == [0, 1]
    np.testing.assert_allclose(peaks.bound[1], 3 * peaks.bound[0], rtol=1e-2)
    np.testing.assert_allclose(peaks.time, peak_of(2.0, 0.1)[1], rtol=0.1)


def test_fast_and_slow_modes_together():
    """The slow mode's peak comes hundreds of the fast mode's periods later, and is not missed."""
    value, time = peak_of(0.05, 0.3)
    system = oscillators((0.05, 0.3), (200.0, 3.0))
    peaks = impulse_peaks(system)
    np.testing.assert_allclose(peaks.bound, value, rtol=2e-3)
    np.testing.assert_allclose(peaks.time, time, rtol=0.1)


def test_what_is_not_seen_does_not_blur_what_is():
    """A huge common motion of two equal masses, and a small relative one."""
    one, (value, _) = oscillators((2.0, 0.1), (2.0, 0.1)), peak_of(2.0, 0.1)
    ways = np.array([[1.0, -1e-6], [1.0, 1e-6]])
    together = StateSpace(np.kron(np.eye(2), one.A), 1e8 * np.kron(ways, one.B)[:, :2], np.kron([[0.5, -0.5]], one.C))
    assert impulse_peaks(together).bound[0] <= 1e-6 * value
    apart = StateSpace(together.A, np.kron(ways, one.B)[:, 2:], together.C)
    np.testing.assert_allclose(impulse_peaks(apart).bound, 1e-6 * value, rtol=2e-3)


def test_an_unstable_system_is_refused():
    with pytest.raises(IllPosedError, match="not asymptotically stable"):
        impulse_peaks(oscillators((1.0, 0.1), (1.0, -0.1)))


def test_errors_are_left_alone_by_a_translation():
    outputs = error_outputs(5)
    np.testing.assert_allclose(outputs @ np.kron(np.ones(5), [0.3, -0.2, 4.0, 5.0]), 0, atol=1e-15)
