"""Matrices of the formation taken apart into the smallest parts that do not act on each other.

With identical robots these are the modes of the communication graph; with other masses, stiffnesses or graphs they are
as small as the parts have in common.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linearization import STATES

Array = NDArray[np.float64]

NEGLIGIBLE = 1e-11
"""Coupling between two parts, relative to the largest entry of the matrix, that is rounding."""


def blocks(matrices: Sequence[Array], masses: Array) -> list[tuple[Array, ...]]:
    """Block-diagonalize several (4N, 4N) matrices at once by one change of the robots' coordinates.

    Positions and velocities are changed alike by M^(1/2) and an orthogonal matrix, so that second-order systems stay
    what they are. Candidates are the eigenvectors of a random combination of the symmetric parts (Murota, Kanno,
    Kojima and Kojima 2010); whatever they are, parts between which any matrix couples are kept together, so the
    blocks have the matrices' spectra, and any sums' and products', up to rounding.

    Args:
        matrices: states robot after robot, as in :class:`~drake_formation.analysis.LinearFormation`.
        masses: of the robots (kg), shape (N,).

    Returns:
        For each block its part of every matrix, shape (2n, 2n): n positions, then their n rates.
    """
    weights = np.sqrt(np.repeat(masses, 2))
    quadrants = np.stack([_by_position_and_velocity(matrix) for matrix in matrices])
    quadrants = weights[:, None] * quadrants / weights
    result = []
    for axes in _components(quadrants):
        part = quadrants[..., axes[:, None], axes]
        basis = _common_basis(part)
        part = basis.T @ part @ basis
        for block in _components(part):
            cut = part[..., block[:, None], block]
            result.append(tuple(np.block([[m[0, 0], m[0, 1]], [m[1, 0], m[1, 1]]]) for m in cut))
    return result


def _by_position_and_velocity(matrix: Array) -> Array:
    """The same matrix as four, shape (2, 2, 2N, 2N): rows and columns of positions (0) and velocities (1)."""
    robots = len(matrix) // STATES
    split = matrix.reshape(robots, 2, 2, robots, 2, 2)
    return split.transpose(1, 4, 0, 2, 3, 5).reshape(2, 2, 2 * robots, 2 * robots)


def _components(quadrants: Array) -> list[NDArray[np.int64]]:
    """Coordinates that act on each other through any of the matrices, directly or not."""
    from scipy.sparse.csgraph import connected_components

    size = np.abs(quadrants)
    largest = size.max(axis=(1, 2, 3, 4), keepdims=True, initial=np.finfo(float).tiny)
    count, label = connected_components((size > NEGLIGIBLE * largest).any(axis=(0, 1, 2)), directed=False)
    return [np.flatnonzero(label == k) for k in range(count)]


def _common_basis(quadrants: Array) -> Array:
    """Eigenvectors of a combination of the symmetric parts: of one that all of them share, if there is any."""
    flat = quadrants.reshape(-1, *quadrants.shape[-2:])
    size = np.abs(flat).max(axis=(1, 2), keepdims=True, initial=np.finfo(float).tiny)
    weights = np.random.default_rng(0).uniform(1.0, 2.0, size.shape)
    combination = (weights * (flat + flat.transpose(0, 2, 1)) / size).sum(axis=0)
    basis: Array = np.linalg.eigh(combination)[1]
    return basis
