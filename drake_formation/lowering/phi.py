"""The functions φ_k of a matrix, which exponential integrators are made of.

φ_0(z) = exp z and φ_{k+1}(z) = (φ_k(z) − 1/k!) / z.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

FUNCTIONS = 4
TERMS = 16
"""Terms of the Taylor series; with a norm of at most a half the rest is below rounding."""


def phi_functions(matrix: Array, levels: int) -> Array:
    """φ_0 … φ_3 of a matrix and of its halves.

    By the Taylor series for a small fraction of the matrix, and doubling from there (Skaflestad & Wright 2009), so that
    the halves come for nothing.

    Args:
        matrix: Z, shape (n, n).
        levels: how many times to halve it.

    Returns:
        φ_k(Z / 2^level), shape (levels + 1, 4, n, n); where they overflow, infinite or not a number.
    """
    norm = float(np.abs(matrix).sum(axis=1).max(initial=0.0))
    halvings = max(levels, int(np.ceil(np.log2(max(norm, 1.0)))) + 1)
    identity, z = np.eye(len(matrix)), matrix / 2.0**halvings
    term = identity / 6.0
    p3 = term.copy()
    for k in range(1, TERMS):
        term = term @ z / (k + 3.0)
        p3 += term
    p2 = z @ p3 + identity / 2.0
    p1 = z @ p2 + identity
    p0 = z @ p1 + identity
    result = np.empty((levels + 1, FUNCTIONS, *matrix.shape))
    with np.errstate(over="ignore", invalid="ignore"):
        for level in range(halvings, -1, -1):
            if level <= levels:
                result[level] = p0, p1, p2, p3
            p0, p1, p2, p3 = (
                p0 @ p0,
                (p0 @ p1 + p1) / 2.0,
                (p1 @ p1 + 2.0 * p2) / 4.0,
                (p1 @ p2 + p2 + 2.0 * p3) / 8.0,
            )
    return result
