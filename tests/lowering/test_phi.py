"""The functions that exponential integrators are made of."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from drake_formation.lowering.phi import phi_functions

LEVELS = 5


@given(seed=st.integers(0, 2**32 - 1), size=st.integers(1, 6), scale=st.sampled_from([1e-6, 0.1, 3.0, 40.0]))
def test_they_are_blocks_of_an_exponential(seed, size, scale):
    """exp of [[Z, 1, 0 …], [0, 0, 1 …], …] has φ_0 … φ_3 in its first row of blocks."""
    z = scale * np.random.default_rng(seed).normal(size=(size, size)) / size
    found = phi_functions(z, LEVELS)
    for level in (0, 1, LEVELS):
        augmented = np.kron(np.eye(4, k=1), np.eye(size))
        augmented[:size, :size] = z / 2.0**level
        expected = expm(augmented)[:size].reshape(size, 4, size).swapaxes(0, 1)
        np.testing.assert_allclose(found[level], expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_zero_gives_the_inverse_factorials():
    found = phi_functions(np.zeros((2, 2)), LEVELS)
    for k, value in enumerate([1, 1, 1 / 2, 1 / 6]):
        np.testing.assert_allclose(found[:, k], np.broadcast_to(value * np.eye(2), (LEVELS + 1, 2, 2)), atol=1e-15)


@pytest.mark.parametrize("rate", [-1e6, -1e3, -1.0, 1.0])
def test_a_scalar(rate):
    zero, one, two, three = phi_functions(np.array([[rate]]), LEVELS)[0, :, 0, 0]
    assert zero == pytest.approx(np.exp(rate), rel=1e-8, abs=1e-300)
    assert one == pytest.approx(np.expm1(rate) / rate)
    assert two == pytest.approx((one - 1) / rate)
    assert three == pytest.approx((two - 1 / 2) / rate, rel=1e-6)
