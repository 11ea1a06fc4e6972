"""A pair of eigenvalues of a loop, followed as a gain rises.

Eigenvalues move continuously with the gain, and so does the plane that the vectors of a pair span, also where two
conjugates meet and go on along the real axis. From one gain to the next the pair is known by its vectors, read in the
coordinates of those before (a modal assurance criterion, with left vectors). Where the pair meets another, or comes
too near to it, the two cannot be told apart from there on.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Loop = Callable[[float], Array]
"""The matrix of a loop (1/s) at a gain."""

SURE = 0.8
"""Share of a vector within the pair's plane before from which on it is the pair's."""

FINEST = 1e-9
"""Step of the gain, relative to it, below which the pair is taken to have met another."""


@dataclass(frozen=True)
class Pair:
    """Two eigenvalues at a gain, conjugates or both real, among all others.

    Attributes:
        gain: the gain.
        values: all eigenvalues of the loop (1/s), shape (n,).
        vectors: their vectors, shape (n, n).
        pair: which two they are.
    """

    gain: float
    values: Complex
    vectors: Complex
    pair: NDArray[np.int64]

    @property
    def eigenvalues(self) -> Complex:
        """The two eigenvalues s₁ and s₂ (1/s)."""
        result: Complex = self.values[self.pair]
        return result

    @property
    def damping_ratio(self) -> float:
        """ζ of (s − s₁)(s − s₂) = s² + 2ζω s + ω²; above 1 where both are real."""
        product = float(np.prod(self.eigenvalues).real)
        return float(-self.eigenvalues.sum().real / (2 * np.sqrt(product))) if product > 0 else -np.inf

    @property
    def decay_rate(self) -> float:
        """How fast the slower of the two dies out (1/s)."""
        return float(-self.eigenvalues.real.max())


def pairs_of(loop: Loop, displacements: Array, gain: float = 0.0) -> list[Pair]:
    """The pairs at a gain whose displacements are most of all some given ones.

    Args:
        loop: of n positions and then their n rates, in coordinates of unit mass.
        displacements: as many as pairs are looked for, orthonormal, shape (n, pairs).
        gain: at which.
    """
    values, vectors = np.linalg.eig(loop(gain))
    moving = vectors[: len(displacements)]
    share = np.sum(np.abs(displacements.T @ moving) ** 2, axis=0) / np.maximum(
        np.sum(np.abs(moving) ** 2, axis=0), np.finfo(float).tiny
    )
    return [Pair(gain, values, vectors, pair) for pair in _paired(values, share)[: displacements.shape[1]]]


def course(pair: Pair, loop: Loop, step: float) -> Iterator[Pair]:
    """The pair at rising gains, until it meets another: forever, if it meets none.

    Args:
        pair: where to begin.
        loop: the loop at any gain.
        step: the first step of the gain; each may be twice the one before.
    """
    finest = FINEST * step
    while step > finest + FINEST * pair.gain:
        onward = at(pair, loop, pair.gain + step)
        if onward is None:
            step /= 4
        else:
            yield onward
            pair, step = onward, 2 * step


def at(before: Pair, loop: Loop, gain: float) -> Pair | None:
    """The pair at a gain not far off, or None where no two vectors are surely its own."""
    values, vectors = np.linalg.eig(loop(gain))
    try:
        weights = np.abs(np.linalg.solve(before.vectors, vectors)) ** 2
    except np.linalg.LinAlgError:
        return None
    share = weights[before.pair].sum(axis=0) / weights.sum(axis=0)
    pair, others = np.split(np.argsort(-share, kind="stable"), [2])
    if share[pair].min() < SURE or np.any(share[others] > 1 - SURE):
        return None
    alike = values[pair[0]] == values[pair[1]].conj() or not values[pair].imag.any()
    return Pair(gain, values, vectors, pair) if alike else None


def _paired(values: Complex, share: Array) -> list[NDArray[np.int64]]:
    """Eigenvalues two by two, those of the greatest share first; the real ones among themselves."""
    order = np.argsort(-share, kind="stable")
    found = []
    while len(order):
        first = values[order[0]]
        partner = order[1:][values[order[1:]] == first.conj()] if first.imag else order[1:][values[order[1:]].imag == 0]
        found.append(np.array([order[0], partner[0]]))
        order = order[~np.isin(order, found[-1])]
    return found
