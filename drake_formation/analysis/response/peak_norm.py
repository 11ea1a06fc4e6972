"""The supremum of the control forces of the linear loop over all time and a set of deviations.

Deviations are x(0) = Σ_b X_b p_b with ‖p_b‖ ≤ r_b, each p_b in the plane, and forces are u_i(t) = Σ_b G_ib(t) p_b.
At one time the largest force is a support function, exact but for one angle n:

    max ‖u_i‖ = max over unit n of Σ_b r_b ‖G_ib(t)ᵀ n‖.

Between two samples h apart a curve leaves its chord by at most h²/8 times its second derivative, which is bounded in
the same way by the fourth. The energy V = xᵀPx, AᵀP + PA ≤ 0, never grows: it bounds everything after the last sample
and, since derivatives of a motion are motions themselves, all derivatives after any sample. So the bound holds for all
t ≥ 0, up to rounding.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation

Array = NDArray[np.float64]

TOLERANCE = 1e-3
"""Intervals whose bound exceeds the largest force found by more than this, relative to it, are sampled finely."""

_PHASE = 0.35
"""Step times the largest eigenvalue (rad): a coarse step; where it matters it is refined."""
_REFINEMENT = 16
_DETOUR = 0.01
"""Steps are doubled while forces leave their chords by less than this, relative to the largest force found."""
_CHUNK = 64
_MOST_CHUNKS = 2000
_ANGLES = 32
_CLIMBS = 4


@dataclass(frozen=True)
class Supremum:
    """Largest force of any robot from a set of deviations: attained value and bound (N), where, when and by what."""

    value: float
    bound: float
    robot: int
    time: float
    weights: Array


def supremum(
    formation: LinearFormation,
    delta: float,
    delta_v: float,
    outputs: Array,
    start: Array,
    radii: Array,
    enough: float = np.inf,
) -> Supremum:
    """The supremum over t ≥ 0 and over x(0) = Σ_b X_b p_b, ‖p_b‖ ≤ r_b, of the largest ‖u_i(t)‖.

    Args:
        formation: the linearized loop.
        delta: δ (N/m).
        delta_v: δ_v (N s/m).
        outputs: C of u = C x, shape (2N, 4N).
        start: the X_b side by side, shape (4N, 2 blocks).
        radii: r_b, shape (blocks,).
        enough: a force (N) that is not looked beyond; once it is exceeded the bound is infinite.

    Raises:
        IllPosedError: the loop is unstable, or too stiff for its slowest mode to be followed.
    """
    loop = formation.closed_loop(delta, delta_v)
    fastest = require_stable(loop, delta, delta_v)
    if not np.any(radii):
        return Supremum(0.0, 0.0, 0, 0.0, np.zeros((len(radii), 2)))
    sweep = _Sweep(loop, outputs, start * np.repeat(radii, 2), energy(formation, loop))
    flagged: list[_Interval] = []
    passed = 0.0
    for interval in sweep.intervals(_PHASE / fastest):
        if sweep.best > enough:
            return Supremum(sweep.best, np.inf, sweep.robot, sweep.time, sweep.weights * radii[:, None])
        if interval.bound > (1 + TOLERANCE) * sweep.best:
            flagged.append(interval)
        else:
            passed = max(passed, interval.bound)
    for interval in flagged:
        coarse = interval.bound <= (1 + TOLERANCE) * sweep.best
        passed = max(passed, interval.bound if coarse else sweep.refine(interval))
    passed = max(passed, sweep.best)
    return Supremum(sweep.best, passed, sweep.robot, sweep.time, sweep.weights * radii[:, None])


def require_stable(loop: Array, delta: float, delta_v: float) -> float:
    """The largest |eigenvalue| of a stable loop (1/s).

    Raises:
        IllPosedError: the loop is unstable.
    """
    values = np.linalg.eigvals(loop)
    if values.real.max() >= 0:
        raise IllPosedError(
            f"the loop is unstable with δ = {delta:g} N/m and δ_v = {delta_v:g} N s/m: a mode at "
            f"{values.real.max():.3g} 1/s never dies out, so its force has no peak"
        )
    return float(np.abs(values).max())


def energy(formation: LinearFormation, loop: Array) -> Array:
    """P of an energy xᵀPx that never grows: AᵀP + PA = −2 diag(0, D), D the symmetric part of the damping.

    With symmetric stiffness and damping it is twice the mechanical energy, P = diag(K, M).
    """
    from scipy.linalg import solve_continuous_lyapunov

    rates = np.arange(len(loop)).reshape(-1, STATES)[:, 2:].ravel()
    mass = np.linalg.inv(formation.B[rates])
    damping = -mass @ loop[np.ix_(rates, rates)]
    values, vectors = np.linalg.eigh(damping + damping.T)
    dissipated = np.zeros_like(loop)
    dissipated[np.ix_(rates, rates)] = (vectors * np.maximum(values, values.max() * 1e-9)) @ vectors.T
    result: Array = solve_continuous_lyapunov(loop.T, -dissipated)
    return (result + result.T) / 2


@dataclass(frozen=True)
class _Interval:
    """From a time on (s), for a step (s): the deviations at its beginning, and what no force in it exceeds (N)."""

    time: float
    step: float
    state: Array
    bound: float


class _Sweep:
    """Samples of all forces along the motion, the largest so far, and bounds between and after samples."""

    def __init__(self, loop: Array, outputs: Array, start: Array, energy_matrix: Array) -> None:
        self.loop, self.start = loop, start
        self.robots = len(outputs) // 2
        self.outputs = np.stack([outputs, outputs @ loop @ loop])
        self.root = _root(energy_matrix)
        by_energy = np.linalg.solve(self.root.T, outputs.T).T.reshape(self.robots, 2, -1)
        self.per_energy = float(np.linalg.norm(by_energy, ord=2, axis=(-2, -1)).max())
        self.best, self.robot, self.time = 0.0, 0, 0.0
        self.weights = np.zeros((start.shape[1] // 2, 2))
        self._exponentials: dict[float, Array] = {}
        angles = np.pi * np.arange(_ANGLES) / _ANGLES
        self.directions = np.column_stack([np.cos(angles), np.sin(angles)])

    def intervals(self, step: float) -> Iterator[_Interval]:
        """Intervals one after another, in longer steps as fast modes die out, until no later one can matter."""
        time, state = 0.0, self.start
        for _ in range(_MOST_CHUNKS):
            powers = self._powers(step, _CHUNK)
            yield from self._chunk(time, state, step, powers)
            time, state = time + _CHUNK * step, powers[-1] @ state
            if self._later(state) <= self.best:
                return
            if self._detour(state, 2 * step) <= _DETOUR * self.best:
                step *= 2
        raise IllPosedError(
            f"after {_MOST_CHUNKS * _CHUNK} steps, {time:.3g} s, the loop still moves: its fastest mode is too fast "
            "for its slowest; a smaller δ or δ_v, or more local damping, brings the two together"
        )

    def refine(self, interval: _Interval) -> float:
        """The force bound of one interval, by finer steps (N)."""
        fine = interval.step / _REFINEMENT
        pieces = self._chunk(interval.time, interval.state, fine, self._powers(fine, _REFINEMENT))
        return max(piece.bound for piece in pieces)

    def _later(self, state: Array) -> float:
        """What no force exceeds from a set of deviations on (N)."""
        return self.per_energy * self._energy_root(state)

    def _detour(self, state: Array, step: float) -> float:
        """How far forces can leave the chord of a step from a set of deviations on (N)."""
        return step**2 / 8 * self._later(self.loop @ (self.loop @ state))

    def _powers(self, step: float, count: int) -> Array:
        """exp(A k step) for k = 0 … count, shape (count + 1, 4N, 4N)."""
        from scipy.linalg import expm

        if step not in self._exponentials:
            one, powers = expm(self.loop * step), [np.eye(len(self.loop))]
            for _ in range(count):
                powers.append(one @ powers[-1])
            self._exponentials[step] = np.stack(powers)
        return self._exponentials[step]

    def _chunk(self, time: float, state: Array, step: float, powers: Array) -> Iterator[_Interval]:
        states = powers @ state
        blocks = (self.outputs[:, None] @ states).reshape(2, len(powers), self.robots, 2, -1, 2)
        values, curvatures = _norm_sums(blocks[0]), _norm_sums(blocks[1])
        for k, robot in np.argwhere(values > self.best):
            if values[k, robot] > self.best:
                values[k, robot] = self._support(blocks[0, k, robot], int(robot), time + k * step)
        sampled = curvatures.max(axis=1)
        bends = np.maximum(sampled[:-1], sampled[1:]) + self._detour(self.loop @ (self.loop @ state), step)
        detours = np.minimum(step**2 / 8 * bends, self._detour(state, step))
        bounds = np.maximum(values[:-1], values[1:]).max(axis=1) + detours
        for k, bound in enumerate(bounds):
            yield _Interval(time + k * step, step, states[k], float(bound))

    def _support(self, blocks: Array, robot: int, time: float) -> float:
        """The largest ‖u‖ at one time and robot, rounded up for the finite number of angles; keeps the record."""
        sums = np.linalg.norm(np.einsum("ak,kbl->abl", self.directions, blocks), axis=-1).sum(axis=1)
        force, weights = _climbed(blocks, self.directions[sums.argmax()])
        if force > self.best:
            self.best, self.robot, self.time, self.weights = force, robot, time, weights
        # The best direction of all is at most half a step away: the value at hand is at least its cosine of the best.
        return float(min(sums.max() / np.cos(np.pi / (2 * _ANGLES)), _norm_sums(blocks[None, None])[0, 0]))

    def _energy_root(self, state: Array) -> float:
        """The largest √V over the set of deviations; robots together by the spectral norm, the travel on its own."""
        roots = self.root @ state
        own, travel = roots[:, :-2], roots[:, -2:]
        together = np.sqrt(own.shape[1] / 2) * np.linalg.norm(own, ord=2) if own.size else 0.0
        return float(together + np.linalg.norm(travel, ord=2))


def _root(energy_matrix: Array) -> Array:
    """The upper Cholesky factor of an energy."""
    try:
        return np.asarray(np.linalg.cholesky(energy_matrix), dtype=float).T
    except np.linalg.LinAlgError:
        raise IllPosedError(
            "the loop's fastest and slowest modes are so far apart that rounding hides its energy; a smaller δ or δ_v, "
            "or more local damping, brings them together"
        ) from None


def _norm_sums(blocks: Array) -> Array:
    """Σ_b ‖G_b‖ (spectral) of blocks of shape (…, 2, b, 2): no direction gives more; shape (…,)."""
    a, b, c, d = blocks[..., 0, :, 0], blocks[..., 0, :, 1], blocks[..., 1, :, 0], blocks[..., 1, :, 1]
    sums = (np.hypot(a + d, b - c) + np.hypot(a - d, b + c)) / 2
    result: Array = sums.sum(axis=-1)
    return result


def _climbed(blocks: Array, direction: Array) -> tuple[float, Array]:
    """‖u‖ and the p_b that make it, from a direction uphill: errors that push along u push u further."""
    for _ in range(_CLIMBS):
        along = np.einsum("k,kbl->bl", direction, blocks)
        lengths = np.linalg.norm(along, axis=-1, keepdims=True)
        weights = along / np.where(lengths > 0, lengths, 1.0)
        force = np.einsum("kbl,bl->k", blocks, weights)
        size = float(np.linalg.norm(force))
        direction = force / (size or 1.0)
    return size, weights
