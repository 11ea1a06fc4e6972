"""Mean-square stability of a linear loop whose channels lose packets independently.

The second moment X = E[x xᵀ] of x(k+1) = Φ x(k), Φ = base + Σ γ_c into_c out_c, with arrivals γ_c that are independent
and 1 with probability q_c, obeys

    X(k+1) = E[Φ X Φᵀ] = M X Mᵀ + Σ_c q_c (1 − q_c) into_c (out_c X out_cᵀ) into_cᵀ,  M = E[Φ]:

it decays exactly if ρ(E[Φ ⊗ Φ]) < 1 (Costa, Fragoso and Marques 2005). That matrix has size n². Its noise, though,
enters as small m × m covariances at a few places alone, and both terms keep a positive semi-definite matrix one. So it
decays exactly if M is stable, and the spectral radius of the map from the covariances that enter to those that M's own
response sends back, times q_c (1 − q_c), is below 1: the mean-square small-gain theorem (Elia 2005; Bamieh and Filo
2020). That map has size m (m + 1)/2 a place, and takes one Stein equation of size n for each.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.analysis.network.sampled_data import SampledLoop

Array = NDArray[np.float64]

DENSE = 60
"""Size of the map up to which it is written out; larger ones are left to Arnoldi's method."""

TRIED = 30
"""Covariances tried in order to bound the radius on the same side of 1."""

ROUNDER = 1e-6
"""So much of the identity keeps them positive definite."""


def mean_square_gain(loop: SampledLoop, arrival: ArrayLike) -> float:
    """The loop gain of the packet loss: mean-square stable exactly if it is below 1.

    Args:
        loop: the sampled loop.
        arrival: probability q that a packet arrives: one for all, or one for every channel, shape (channels,).

    Returns:
        The gain; infinity where the mean itself is unstable.
    """
    from scipy.sparse.linalg import LinearOperator, eigs

    arrivals = np.broadcast_to(np.asarray(arrival, dtype=float), loop.place.shape)
    mean = loop.mean(arrivals)
    if np.abs(np.linalg.eigvals(mean)).max() >= 1:
        return np.inf
    response = _CovarianceResponse(loop, mean, arrivals * (1 - arrivals))
    if response.size <= DENSE:
        values = np.linalg.eigvals(np.column_stack([response(column) for column in np.eye(response.size)]))
    else:
        operator = LinearOperator((response.size, response.size), response, dtype=float)
        values = eigs(operator, k=1, v0=response.identities(), return_eigenvectors=False)
    return float(np.abs(values).max(initial=0.0))


def decays_in_mean_square(loop: SampledLoop, arrival: ArrayLike) -> bool:
    """Whether the second moment decays, which takes a few Stein equations to tell except where it hardly does.

    The map keeps covariances positive semi-definite: where it takes positive definite ones to smaller ones its spectral
    radius is below 1, and where to larger ones above (Collatz and Wielandt).

    Args:
        loop: the sampled loop.
        arrival: as for :func:`mean_square_gain`, whose sign about 1 this is.
    """
    arrivals = np.broadcast_to(np.asarray(arrival, dtype=float), loop.place.shape)
    mean = loop.mean(arrivals)
    if np.abs(np.linalg.eigvals(mean)).max() >= 1:
        return False
    if not len(loop.place):
        return True
    response = _CovarianceResponse(loop, mean, arrivals * (1 - arrivals))
    covariances = response.identities()
    for _ in range(TRIED):
        after = response(covariances)
        factors = response.growth(covariances, after)
        if factors.max() < 1 or factors.min() > 1:
            return bool(factors.max() < 1)
        covariances = after / np.abs(after).max() + ROUNDER * response.identities()
    return mean_square_gain(loop, arrivals) < 1


class _CovarianceResponse:
    """From covariances that enter once, at every place, to the sum of those that the mean's response sends there.

    That sum over time X = Σ M^k W M^kᵀ solves the Stein equation X = M X Mᵀ + W. With S = (M − I)(M + I)⁻¹ it is the
    Lyapunov equation S X + X Sᵀ = −2 (M + I)⁻¹ W (M + I)⁻ᵀ, solved in the Schur basis of S, computed once.
    """

    def __init__(self, loop: SampledLoop, mean: Array, variances: Array) -> None:
        from scipy.linalg import schur

        one = np.eye(len(mean))
        inverse = np.linalg.inv(mean + one)
        self._triangular, basis = schur((mean - one) @ inverse)
        self._into = basis.T @ inverse @ loop.into
        self._out = np.sqrt(variances)[:, None, None] * (loop.out @ basis)
        self._place = loop.place
        self._rows, self._columns = np.triu_indices(loop.into.shape[2])

    @property
    def size(self) -> int:
        """Numbers of all covariances: the upper triangles, place after place."""
        return len(self._into) * len(self._rows)

    def identities(self) -> Array:
        """The identity as covariance at every place."""
        return np.tile((self._rows == self._columns).astype(float), len(self._into))

    def matrices(self, covariances: Array) -> Array:
        """The covariances themselves, shape (places, m, m)."""
        triangles = covariances.reshape(len(self._into), -1)
        result = np.zeros((len(self._into), *2 * self._into.shape[2:]))
        result[:, self._rows, self._columns] = result[:, self._columns, self._rows] = triangles
        return result

    def growth(self, before: Array, after: Array) -> Array:
        """Between which factors covariances, positive definite before, have grown at every place, shape (places, m)."""
        from scipy.linalg import eigvalsh

        pairs = zip(self.matrices(after), self.matrices(before), strict=True)
        return np.array([eigvalsh(now, then) for now, then in pairs])

    def __call__(self, covariances: Array) -> Array:
        """The upper triangles of the covariances at every place, to the same."""
        from scipy.linalg.lapack import dtrsyl

        source = np.hstack(list(self._into @ self.matrices(covariances))) @ np.hstack(list(self._into)).T
        solution, scale, _ = dtrsyl(self._triangular, self._triangular, -2 * source, tranb="T")
        ahead = (self._out.reshape(-1, len(solution)) @ solution / scale).reshape(self._out.shape)
        sent = ahead @ self._out.transpose(0, 2, 1)
        collected = np.zeros((len(self._into), len(self._rows)))
        np.add.at(collected, self._place, sent[:, self._rows, self._columns])
        return collected.ravel()
