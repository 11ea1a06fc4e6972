"""Mean-square stability of a linear loop whose channels lose packets independently.

The second moment X = E[x xᵀ] of x(k+1) = Φ x(k), Φ = base + Σ γ_c into_c out_c, with arrivals γ_c that are independent
and 1 with probability q, obeys

    X(k+1) = E[Φ X Φᵀ] = M X Mᵀ + q (1 − q) Σ_c into_c (out_c X out_cᵀ) into_cᵀ,  M = E[Φ]:

it decays exactly if ρ(E[Φ ⊗ Φ]) < 1 (Costa, Fragoso and Marques 2005). That matrix has size n². Its noise, though,
enters as 2 × 2 covariances at a few places alone, and both terms keep a positive semi-definite matrix one. So it decays
exactly if M is stable, and q (1 − q) times the spectral radius of the map from the covariances that enter to those that
M's own response sends back is below 1: the mean-square small-gain theorem (Elia 2005; Bamieh and Filo 2020). That map
has size three a place, and takes one Stein equation of size n for each.
"""

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.network.sampled_data import SampledLoop

Array = NDArray[np.float64]

DENSE = 60
"""Size of the map up to which it is written out; larger ones are left to Arnoldi's method."""

SYMMETRIC = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 1.0], [1.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]]])
"""A basis of the symmetric 2 × 2 matrices."""


def mean_square_gain(loop: SampledLoop, arrival: float) -> float:
    """The loop gain of the packet loss: mean-square stable exactly if it is below 1.

    Args:
        loop: the sampled loop.
        arrival: probability q that a packet arrives.

    Returns:
        The gain; infinity where the mean itself is unstable.
    """
    from scipy.sparse.linalg import LinearOperator, eigs

    mean = loop.mean(arrival)
    if np.abs(np.linalg.eigvals(mean)).max() >= 1:
        return np.inf
    response = _CovarianceResponse(loop, mean)
    size = 3 * len(loop.into)
    if size <= DENSE:
        values = np.linalg.eigvals(np.column_stack([response(column) for column in np.eye(size)]))
    else:
        start = np.tile([1.0, 0.0, 1.0], len(loop.into))
        values = eigs(LinearOperator((size, size), response, dtype=float), k=1, v0=start, return_eigenvectors=False)
    return float(arrival * (1 - arrival) * np.abs(values).max())


class _CovarianceResponse:
    """From covariances that enter once, at every place, to the sum of those that the mean's response sends there.

    That sum over time X = Σ M^k W M^kᵀ solves the Stein equation X = M X Mᵀ + W. With S = (M − I)(M + I)⁻¹ it is the
    Lyapunov equation S X + X Sᵀ = −2 (M + I)⁻¹ W (M + I)⁻ᵀ, solved in the Schur basis of S, computed once.
    """

    def __init__(self, loop: SampledLoop, mean: Array) -> None:
        from scipy.linalg import schur

        one = np.eye(len(mean))
        inverse = np.linalg.inv(mean + one)
        self._triangular, basis = schur((mean - one) @ inverse)
        self._into = basis.T @ inverse @ loop.into
        self._out = loop.out @ basis
        self._place = loop.place

    def __call__(self, covariances: Array) -> Array:
        """Three numbers a place, in ``SYMMETRIC``, to three numbers a place."""
        from scipy.linalg.lapack import dtrsyl

        entering = np.einsum("pk,kij->pij", covariances.reshape(-1, 3), SYMMETRIC)
        source = np.hstack(list(self._into @ entering)) @ np.hstack(list(self._into)).T
        solution, scale, _ = dtrsyl(self._triangular, self._triangular, -2 * source, tranb="T")
        ahead = (self._out.reshape(-1, len(solution)) @ solution / scale).reshape(self._out.shape)
        sent = ahead @ self._out.transpose(0, 2, 1)
        collected = np.zeros((len(self._into), 3))
        np.add.at(collected, self._place, sent[:, [0, 0, 1], [0, 1, 1]])
        return collected.ravel()
