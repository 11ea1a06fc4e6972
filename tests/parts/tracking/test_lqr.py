import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import solve_continuous_are
from strategies import cost, generators

from drake_formation.parts.tracking.lqr import lqr_gain, robot_matrices, tracking_force

masses = st.floats(0.1, 1000)
weights = st.floats(0.01, 100)


def test_the_papers_gain_is_exact():
    gain = lqr_gain(40.0, np.eye(4), np.eye(2))
    np.testing.assert_allclose(gain, [[1, 0, 9, 0], [0, 1, 0, 9]], rtol=0, atol=1e-12)


@given(masses, weights, weights)
def test_gain_for_multiples_of_the_identity_follows_the_formula(mass, q, r):
    gain = lqr_gain(mass, q * np.eye(4), r * np.eye(2))
    stiffness = np.sqrt(q / r)
    damping = np.sqrt(q / r + 2 * mass * stiffness)
    expected = np.hstack([stiffness * np.eye(2), damping * np.eye(2)])
    np.testing.assert_allclose(gain, expected, rtol=1e-9, atol=1e-9 * damping)


@given(masses, generators)
def test_gain_solves_the_riccati_equation(mass, rng):
    a, b = robot_matrices(mass)
    q, r = np.array(cost(rng, 4, isotropic=False)), np.array(cost(rng, 2, isotropic=False))
    expected = np.linalg.solve(r, b.T @ solve_continuous_are(a, b, q, r))
    np.testing.assert_allclose(lqr_gain(mass, q, r), expected, rtol=1e-6, atol=1e-6 * abs(expected).max())


@given(masses, generators)
def test_gain_stabilizes_the_robot(mass, rng):
    a, b = robot_matrices(mass)
    gain = lqr_gain(mass, cost(rng, 4, isotropic=False), cost(rng, 2, isotropic=False))
    assert np.linalg.eigvals(a - b @ gain).real.max() < 0


def test_the_papers_feed_forward_vanishes():
    a, b = robot_matrices(40.0)
    assert not (np.linalg.pinv(b) @ a).any()


@given(generators)
def test_force_is_the_gain_times_the_error(rng):
    gain, error = rng.uniform(-10, 10, (2, 4)), rng.uniform(-10, 10, 4)
    force = tracking_force(tuple(error.tolist()), gain.ravel().tolist())
    assert force == pytest.approx(tuple(-gain @ error), rel=1e-12, abs=1e-12)
