"""Modes of the closed loop by Laplacian eigenvalue (paper, Theorem 2 and Lemma 1).

Where the parts of the loop leave the Laplacian's eigenspaces to themselves (identical robots under consensus alone,
or with springs that commute with the Laplacian, such as any object under a complete graph), the loop falls apart into
one small block per Laplacian eigenvalue λ; without springs and for K_l = [p I, d I] into

    m s² + (d + δ_v λ) s + p + δ λ = 0.

Eigenspaces that the loop couples are solved together, and their modes carry a mean λ.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import STATES, Array, LinearFormation
from drake_formation.analysis.linear.motion_subspaces import PARTS, ROUNDING, parts, positions

Complex = NDArray[np.complex128]

SETTLED = 0.02
"""A mode has settled when its amplitude stays below this share of its beginning."""

ALIKE = 1e-6
"""Eigenvalues nearer to each other than this, relative to their size, are one: a double root is found to √eps only."""


@dataclass(frozen=True)
class Mode:
    """Motions of one eigenvalue.

    Attributes:
        eigenvalue: s (1/s), with Im s ≥ 0; a pair of conjugates is one entry.
        count: how many times it occurs.
        laplacian_eigenvalue: λ of the communication graph; where the loop couples several, their mean over the mode.
        decoupled: the mode belongs to this λ alone.
        shares: how much of its displacement is of each part, as in
            :mod:`drake_formation.analysis.linear.motion_subspaces`; sums to 1.
        robots: how much of its displacement is of each robot, shape (N,); sums to 1.
        moved_by_consensus: whether δ or δ_v move it.
    """

    eigenvalue: complex
    count: int
    laplacian_eigenvalue: float
    decoupled: bool
    shares: dict[str, float]
    robots: Array
    moved_by_consensus: bool

    @property
    def kind(self) -> str:
        """The part that it mostly is."""
        return max(PARTS, key=lambda part: round(self.shares[part], 6))

    @property
    def decay_rate(self) -> float:
        """−Re s (1/s); negative where the mode grows."""
        return -self.eigenvalue.real

    @property
    def frequency(self) -> float:
        """Im s (rad/s); 0 where the mode does not oscillate."""
        return self.eigenvalue.imag

    @property
    def damping_ratio(self) -> float:
        """−Re s / |s|; 1 where the mode does not oscillate."""
        return self.decay_rate / max(abs(self.eigenvalue), 1e-300)

    @property
    def settling_time(self) -> float | None:
        """Time until its amplitude stays below 2 % (s); None where it does not decay."""
        return float(-np.log(SETTLED) / self.decay_rate) if self.decay_rate > 0 else None

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "kind": self.kind,
            "count": self.count,
            "laplacian_eigenvalue": self.laplacian_eigenvalue,
            "decoupled": self.decoupled,
            "eigenvalue_1_per_s": [self.eigenvalue.real, self.eigenvalue.imag],
            "decay_rate_1_per_s": self.decay_rate,
            "frequency_rad_per_s": self.frequency,
            "damping_ratio": self.damping_ratio,
            "settling_time_s": self.settling_time,
            "shares": self.shares,
            "robots": self.robots.tolist(),
            "moved_by_consensus": self.moved_by_consensus,
        }


@dataclass(frozen=True)
class Modes:
    """Every mode of the closed loop, by Laplacian eigenvalue and then by frequency.

    Attributes:
        modes: the modes; their counts, twice for a pair, add up to 4N.
        laplacian_eigenvalues: of the communication graph, ascending, shape (N,); the second is the algebraic
            connectivity.
        decay_limit: no δ makes the slowest of the modes that consensus moves decay faster than this (1/s), at the
            scenario's δ_v: their decay rates add up to the trace, which does not contain δ. None where consensus
            moves no mode.
    """

    modes: tuple[Mode, ...]
    laplacian_eigenvalues: Array
    decay_limit: float | None

    @cached_property
    def slowest(self) -> tuple[Mode, ...]:
        """The modes that decay slowest, or grow fastest; more than one where rounding cannot tell them apart."""
        least = min(mode.decay_rate for mode in self.modes)
        return tuple(mode for mode in self.modes if mode.decay_rate <= least + ALIKE * abs(least))

    @property
    def stable(self) -> bool | None:
        """Whether every mode decays; None where rounding hides it."""
        if self.unstable:
            return False
        return True if all(mode.decay_rate > self._rounding for mode in self.modes) else None

    @property
    def unstable(self) -> tuple[Mode, ...]:
        """The modes that grow, beyond what rounding may have done."""
        return tuple(mode for mode in self.modes if mode.decay_rate < -self._rounding)

    @property
    def _rounding(self) -> float:
        """Decay rates below this (1/s) cannot be told from 0 beside the fastest mode."""
        return 1e-12 * max(abs(mode.eigenvalue) for mode in self.modes)


def modes(formation: LinearFormation) -> Modes:
    """Modes of a formation, stable or not."""
    moved = np.vstack([formation.per_delta, formation.per_delta_v])
    basis = parts(formation)
    found = [
        _mode(formation, eigenvalue, vectors, decoupled, basis, moved)
        for space, decoupled in _blocks(formation)
        for eigenvalue, vectors in _eigenspaces(space.T @ formation.A @ space, space)
    ]
    found.sort(key=lambda mode: (round(mode.laplacian_eigenvalue, 6), mode.frequency, mode.decay_rate))
    return Modes(
        modes=tuple(found),
        laplacian_eigenvalues=np.asarray(np.linalg.eigvalsh(formation.laplacian), dtype=float),
        decay_limit=decay_limit(formation),
    )


def decay_limit(formation: LinearFormation) -> float | None:
    """What the decay rate of the slowest mode that consensus moves stays below for every δ (1/s); see ``Modes``."""
    unmoved = _unmovable(formation)
    count = len(unmoved) - unmoved.shape[1]
    if not count:
        return None
    free = formation.tracking + formation.springs
    return float((np.trace(unmoved.T @ free @ unmoved) - np.trace(formation.A)) / count)


def movable(formation: LinearFormation) -> Array:
    """Orthonormal basis of the states that are orthogonal to what consensus cannot move, shape (4N, dimensions).

    ``space.T @ A @ space`` has the eigenvalues that depend on δ or δ_v. For identical robots the motion of the centre
    is left out; if masses differ, usually nothing is.
    """
    return _null_space(_unmovable(formation).T)


def _unmovable(formation: LinearFormation) -> Array:
    """Orthonormal basis of the motions that are the same for all δ and δ_v: robots that talk always agree in them.

    It is the unobservable subspace of the loop without consensus, seen through L ⊗ I.
    """
    free = formation.tracking + formation.springs
    unmoved = _null_space(np.vstack([formation.per_delta, formation.per_delta_v]))
    while unmoved.shape[1]:
        onward = free @ unmoved
        outside = onward - unmoved @ (unmoved.T @ onward)
        kept = _null_space(outside, scale=float(np.linalg.norm(free)))
        if kept.shape[1] == unmoved.shape[1]:
            break
        unmoved = unmoved @ kept
    return unmoved


def _null_space(matrix: Array, scale: float | None = None) -> Array:
    """Orthonormal basis of what a matrix maps to nothing, compared with a scale (its own norm if not given)."""
    _, values, rows = np.linalg.svd(matrix, full_matrices=True)
    largest = max(values, default=0.0) if scale is None else scale
    result: Array = rows[np.sum(values > ROUNDING * largest) :].T
    return result


def _blocks(formation: LinearFormation) -> list[tuple[Array, bool]]:
    """Subspaces of the state that the loop leaves to themselves, and whether each is of one Laplacian eigenvalue."""
    values, vectors = np.linalg.eigh(formation.laplacian)
    new = np.diff(values, prepend=-np.inf) > ROUNDING * max(values[-1], 1.0)
    spaces = [np.kron(space, np.eye(STATES)) for space in np.split(vectors, np.flatnonzero(new)[1:], axis=1)]
    coupled = nx.empty_graph(len(spaces))
    scale = float(np.abs(formation.A).max())
    for i, one in enumerate(spaces):
        onward = formation.A @ one
        coupled.add_edges_from(
            (i, j) for j, two in enumerate(spaces) if np.abs(two.T @ onward).max() > ROUNDING * scale
        )
    groups = [sorted(group) for group in nx.connected_components(coupled)]
    return [(np.hstack([spaces[i] for i in group]), len(group) == 1) for group in groups]


def _eigenspaces(block: Array, space: Array) -> list[tuple[complex, Complex]]:
    """Eigenvalues of a block with Im ≥ 0 and their eigenvectors as states of the formation; equal ones together."""
    values, vectors = np.linalg.eig(block)
    size = ALIKE * np.maximum(np.abs(values), ALIKE * np.abs(values).max())
    values = np.where(np.abs(values.imag) <= size, values.real, values).astype(complex)
    upper = np.flatnonzero(values.imag >= 0)
    near = nx.empty_graph(upper)
    for i in upper:
        near.add_edges_from((i, j) for j in upper if abs(values[i] - values[j]) <= size[i])
    groups = [sorted(group) for group in nx.connected_components(near)]
    return [(complex(values[group].mean()), space @ vectors[:, group]) for group in groups]


def _mode(
    formation: LinearFormation,
    eigenvalue: complex,
    vectors: Complex,
    decoupled: bool,
    basis: dict[str, Array],
    moved: Array,
) -> Mode:
    robots = formation.robots
    # Vectors of one eigenvalue are any basis of its space: orthonormal displacements stand for all of them alike.
    orthonormal, values, _ = np.linalg.svd(vectors[positions(robots)], full_matrices=False)
    shape = orthonormal[:, values > ALIKE * values[0]]
    weight = np.sum(np.abs(shape.reshape(robots, 2, -1)) ** 2, axis=(1, 2)) / shape.shape[1]
    on_graph = np.kron(formation.laplacian, np.eye(2)) @ shape
    mean = float(np.sum(shape.conj() * on_graph).real) / shape.shape[1]
    return Mode(
        eigenvalue=eigenvalue,
        count=vectors.shape[1],
        laplacian_eigenvalue=mean if mean > ROUNDING * np.abs(formation.laplacian).max() else 0.0,
        decoupled=decoupled,
        shares={name: _share(part, shape) for name, part in basis.items()},
        robots=weight,
        moved_by_consensus=bool(np.abs(moved @ vectors).max() > ROUNDING * max(float(np.abs(moved).max()), 1e-300)),
    )


def _share(part: Array, shape: Complex) -> float:
    return float(np.sum(np.abs(part.T @ shape) ** 2) / shape.shape[1])
