"""The peak of an impulse response, bounded from above for all time.

For ẋ = A x + B f, y = C x from rest, ‖y(t)‖ ≤ ∫ ‖C e^{A(t−τ)} B‖ ‖f(τ)‖ dτ: no force of total impulse J = ∫ ‖f‖ dt
moves y by more than J times the largest ‖C e^{At} B‖, and a short blow comes as near to that as one likes. It is the
norm from L1 to L∞ (Desoer and Vidyasagar 1975; Chellaboina, Haddad, Bernstein, Wilson 2000).
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.norms import StateSpace, require_stable

Array = NDArray[np.float64]

CHUNK = 32
"""Intervals of time looked at together."""

_FAINT = 1e-6


@dataclass(frozen=True)
class ImpulsePeaks:
    """The largest ‖C_i e^{At} B_j‖ over all times t ≥ 0 and robots i, for every robot j that is hit.

    Attributes:
        bound: no response is ever larger; shape (N,), as all others.
        reached: a response this large was found; at most the tolerance below the bound.
        time: when (s).
        robot: at which robot, from 0.
    """

    bound: Array
    reached: Array
    time: Array
    robot: NDArray[np.int64]


def impulse_peaks(system: StateSpace, *, tolerance: float = 1e-3) -> ImpulsePeaks:
    """Bound the impulse response, with certainty up to rounding.

    On t₀ ≤ t ≤ t₀ + 2r about the centre c, h(t) is within r²/2 · sup ‖ḧ‖ of its tangent, and the norm of a tangent is
    largest at an end. The supremum over all later times comes from a Lyapunov function, which only decreases.
    Intervals are halved until every one is clear of the largest response found, and time ends when a Lyapunov
    function says that nothing that large can come.

    Args:
        system: with two inputs (x and y) for each robot that is hit and two outputs for each robot that errs.
        tolerance: what the bound may exceed the largest response by, relative.

    Raises:
        IllPosedError: the system is not stable.
    """
    require_stable(system.A)
    return _Search(_seen_part(system), tolerance).run()


def _seen_part(system: StateSpace) -> StateSpace:
    """The system without motions that neither show nor lead to any that do: equal robots moving all alike.

    However large they are, they must not blur the bound on the others.
    """
    shown = np.vstack([system.C, system.C @ system.A])
    _, sizes, directions = np.linalg.svd(shown)
    rank = int(np.count_nonzero(sizes > 1e-10 * sizes[0]))
    seen, unseen = directions[:rank].T, directions[rank:].T
    if np.abs(seen.T @ system.A @ unseen).max(initial=0.0) > 1e-10 * np.abs(system.A).max():
        return system
    return StateSpace(seen.T @ system.A @ seen, seen.T @ system.B, system.C @ seen)


def block_norms(matrices: Array) -> Array:
    """Spectral norms of the 2 × 2 blocks of matrices, shape (…, rows / 2, columns / 2)."""
    *stack, rows, columns = matrices.shape
    blocks = matrices.reshape(*stack, rows // 2, 2, columns // 2, 2)
    a, b, c, d = blocks[..., 0, :, 0], blocks[..., 0, :, 1], blocks[..., 1, :, 0], blocks[..., 1, :, 1]
    # Twice the larger singular value: the parts of a 2 × 2 matrix that turn and that mirror add up.
    result: Array = (np.hypot(a + d, b - c) + np.hypot(a - d, b + c)) / 2
    return result


@dataclass
class _Search:
    system: StateSpace
    tolerance: float
    reached: Array = field(init=False)
    time: Array = field(init=False)
    robot: NDArray[np.int64] = field(init=False)

    def __post_init__(self) -> None:
        inputs = self.system.B.shape[1] // 2
        self.reached, self.time, self.robot = np.zeros(inputs), np.zeros(inputs), np.zeros(inputs, dtype=np.int64)
        rates = self.system.C @ self.system.A
        self._tail = _Envelope(self.system.A, self.system.C)
        self._curvature = _Envelope(self.system.A, rates @ self.system.A)
        self._outputs = np.vstack([self.system.C, rates])
        # Half a radian of the fastest mode to an interval at first; powers of two share their exponentials.
        self._radius = 2.0 ** np.floor(np.log2(0.25 / np.abs(np.linalg.eigvals(self.system.A)).max()))
        self._exponentials: dict[float, Array] = {}

    def run(self) -> ImpulsePeaks:
        start, time, radius = self.system.B, 0.0, self._radius
        self._note(block_norms(self.system.C @ start)[None], np.zeros(1))
        while np.any(self._tail.after(start[None]).max(axis=1)[0] > self._threshold()):
            starts = self._march(start, radius)
            times = time + 2 * radius * np.arange(CHUNK)
            refined = self._clear(starts, times, radius)
            start, time = self._exponential(2 * radius) @ starts[-1], time + 2 * radius * CHUNK
            radius = radius / 2 if refined > CHUNK / 2 else radius * 2 if refined == 0 else radius
        return ImpulsePeaks(self._threshold(), self.reached, self.time, self.robot)

    def _threshold(self) -> Array:
        # A force that moves nothing by comparison is as good as none.
        threshold: Array = np.maximum(self.reached * (1 + self.tolerance), _FAINT * self.reached.max())
        return threshold

    def _clear(self, starts: Array, times: Array, radius: float) -> int:
        """Make sure that no response in these intervals is larger than the largest found; how many had to be split."""
        centres = self._exponential(radius) @ starts
        here, rate = np.split(self._outputs @ centres, 2, axis=1)
        slope = radius * rate
        self._note(block_norms(here), times + radius)
        ends = np.maximum(block_norms(here + slope), block_norms(here - slope))
        bounds = ends + radius**2 / 2 * self._curvature.after(starts)
        unclear = np.any(bounds.max(axis=1) > self._threshold(), axis=1)
        if unclear.any():
            halves = np.concatenate([starts[unclear], centres[unclear]])
            self._clear(halves, np.concatenate([times[unclear], times[unclear] + radius]), radius / 2)
        return int(np.count_nonzero(unclear))

    def _note(self, norms: Array, times: Array) -> None:
        """Keep the largest responses of a stack of shape (times, N, hit)."""
        largest = norms.max(axis=1)
        when = largest.argmax(axis=0)
        columns = np.arange(len(when))
        better = largest[when, columns] > self.reached
        self.reached = np.where(better, largest[when, columns], self.reached)
        self.time = np.where(better, times[when], self.time)
        self.robot = np.where(better, norms.argmax(axis=1)[when, columns], self.robot)

    def _march(self, start: Array, radius: float) -> Array:
        """States at the beginnings of a chunk of intervals, shape (CHUNK, n, m)."""
        states = start[None]
        step = 2 * radius
        while len(states) < CHUNK:
            states = np.concatenate([states, self._exponential(step) @ states])
            step *= 2
        return states

    def _exponential(self, time: float) -> Array:
        if time not in self._exponentials:
            from scipy.linalg import expm

            self._exponentials[time] = expm(self.system.A * time)
        return self._exponentials[time]


class _Envelope:
    """A bound on ‖W_i e^{As} x‖ for all s ≥ 0 that needs x alone: ‖W_i X^{-1/2}‖ ‖X^{1/2} x‖.

    Along the motion xᵀ X x decreases, since Aᵀ X + X A = −(Wᵀ W + ε I).
    """

    def __init__(self, A: Array, weights: Array) -> None:
        from scipy.linalg import solve_continuous_lyapunov, solve_triangular

        weight = weights.T @ weights
        # A little of every state keeps X definite where W does not see all.
        weight = weight + 1e-6 * np.linalg.norm(weight, 2) * np.eye(len(A))
        energy = solve_continuous_lyapunov(A.T, -weight)
        self._root = np.linalg.cholesky((energy + energy.T) / 2).T
        rows = solve_triangular(self._root, weights.T, trans="T").T.reshape(-1, 2, len(A))
        self._outputs = np.linalg.norm(rows, 2, axis=(1, 2))

    def after(self, states: Array) -> Array:
        """Bounds from states of shape (stack, n, m) on; shape (stack, N, hit)."""
        energies = (self._root @ states).reshape(*states.shape[:2], -1, 2)
        x, y = energies[..., 0], energies[..., 1]
        p, q, r = (x**2).sum(axis=1), (y**2).sum(axis=1), (x * y).sum(axis=1)
        inputs = np.sqrt((p + q) / 2 + np.hypot((p - q) / 2, r))
        result: Array = self._outputs[:, None] * inputs[:, None, :]
        return result
