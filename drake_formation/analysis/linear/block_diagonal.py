"""Matrices of the formation taken apart into the smallest parts that do not act on each other.

With identical robots these are the modes of the communication graph; with other masses, stiffnesses or graphs they are
as small as the parts have in common.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import STATES

Array = NDArray[np.float64]

NEGLIGIBLE = 1e-11
"""Coupling between two parts, relative to the largest entry of the matrix, that is rounding."""

SAME = 1e-9
"""Two numbers that differ by less than this, relative to the largest, are one."""

SAME_DIGITS = 12
"""Blocks that agree to so many digits are one."""


def blocks(matrices: Sequence[Array], masses: Array) -> list[tuple[Array, ...]]:
    """Block-diagonalize several (4N, 4N) matrices at once by one change of the robots' coordinates.

    Positions and velocities are changed alike by M^(1/2) and an orthogonal matrix, so that second-order systems stay
    what they are. Candidates are the eigenvectors of a random combination of the symmetric parts (Murota, Kanno,
    Kojima and Kojima 2010), turned so that repeated parts come apart; whatever they are, parts between which any
    matrix couples are kept together, so the blocks have the matrices' spectra, and any sums' and products', up to
    rounding.

    Args:
        matrices: states robot after robot, as in :class:`~drake_formation.analysis.LinearFormation`.
        masses: of the robots (kg), shape (N,).

    Returns:
        For each block its part of every matrix, shape (2n, 2n): n positions, then their n rates.
    """
    return [tuple(reduced(matrix, basis, masses) for matrix in matrices) for basis in bases(matrices, masses)]


def bases(matrices: Sequence[Array], masses: Array) -> list[Array]:
    """The displacements that make up each block: of unit mass and orthogonal with respect to the masses.

    Args:
        matrices: as for :func:`blocks`.
        masses: of the robots (kg), shape (N,).

    Returns:
        For each block its n displacements of all robots, shape (2N, n).
    """
    weights = np.sqrt(np.repeat(masses, 2))
    quadrants = np.stack([_by_position_and_velocity(matrix) for matrix in matrices])
    quadrants = weights[:, None] * quadrants / weights
    result = []
    for axes in _components(quadrants):
        part = quadrants[..., axes[:, None], axes]
        basis = _common_basis(part)
        for block in _components(basis.T @ part @ basis):
            displacements = np.zeros((len(weights), len(block)))
            displacements[axes] = basis[:, block]
            result.append(displacements / weights[:, None])
    return result


def reduced(matrix: Array, basis: Array, masses: Array) -> Array:
    """A matrix's part for some displacements, shape (2n, 2n): n positions, then their n rates."""
    m = (np.repeat(masses, 2)[:, None] * basis).T @ _by_position_and_velocity(matrix) @ basis
    return np.block([[m[0, 0], m[0, 1]], [m[1, 0], m[1, 1]]])


def distinct(parts: Sequence[tuple[Array, ...]]) -> list[tuple[Array, ...]]:
    """Blocks without repetition, small ones first: identical robots have modes many times over."""
    size = max(np.abs(matrix).max() for part in parts for matrix in part)
    found = {(np.round(np.hstack(part) / size, SAME_DIGITS) + 0.0).tobytes(): part for part in parts}
    return sorted(found.values(), key=lambda part: len(part[0]))


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
    values, basis = np.linalg.eigh(combination)
    new = np.diff(values) > SAME * np.abs(values).max(initial=0.0)
    return np.hstack(_aligned(np.split(basis, np.flatnonzero(new) + 1, axis=1), flat / size))


def _aligned(spaces: list[Array], matrices: Array) -> list[Array]:
    """Bases of eigenspaces turned so that a part that occurs many times is taken apart, each copy by itself.

    Between the eigenspaces of such a part every matrix is a number times one orthogonal matrix; undone in one of the
    two, it is a number times the identity.
    """
    spaces, waiting = list(spaces), set(range(len(spaces)))
    while waiting:
        reached = [min(waiting)]
        for i in reached:
            waiting.discard(i)
            for j in sorted(waiting):
                turn = _turn(spaces[i], spaces[j], matrices)
                if turn is not None:
                    spaces[j] = spaces[j] @ turn.T
                    waiting.discard(j)
                    reached.append(j)
    return spaces


def _turn(one: Array, two: Array, matrices: Array) -> Array | None:
    """The orthogonal matrix of which the strongest coupling of two eigenspaces is a multiple, if it is of any."""
    if one.shape != two.shape or one.shape[1] == 1:
        return None
    couplings = one.T @ matrices @ two
    coupling = couplings[np.argmax(np.linalg.norm(couplings, axis=(1, 2)))]
    size = np.linalg.norm(coupling) / np.sqrt(len(coupling))
    if size <= NEGLIGIBLE:
        return None
    left, sizes, right = np.linalg.svd(coupling)
    turn: Array = left @ right
    return turn if sizes.max() - sizes.min() <= SAME * size else None
