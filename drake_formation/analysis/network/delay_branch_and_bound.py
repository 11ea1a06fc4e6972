"""The critical delays of larger systems, for which the quadratic eigenproblem is too large: branch and bound.

The quadratic eigenproblem of n states has size 2 n²: 7200 for thirty robots of one axis. Instead the phase θ of
z = e^{−jθ} is divided into intervals. On each, Gershgorin's discs, in the basis of the eigenvectors at its middle, hold
every eigenvalue of A₀ + z A₁: where none reaches the imaginary axis, or only at delays θ/ω that do not matter, such as
ones longer than the least one found, the interval is done; else it is halved. Nothing between samples is overlooked.
"""

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.network.crossing import AT_REST, Crossing, crossing, followed, least

Array = NDArray[np.float64]

PROVEN = 1e-6
"""No crossing lies below the least delay found by more than this part of it."""

FORESIGHT = 0.4
"""Half a phase interval (rad) up to which what is foreseen from its middle is worth following."""

NARROWEST = 1e-9
"""Half a phase interval (rad) within which a root that cannot be told from the imaginary axis is taken to touch it."""


def search(present: Array, delayed: Array, below: float = np.inf) -> Crossing | None:
    """The crossing of least delay of ẋ = A₀ x(t) + A₁ x(t − τ).

    The conjugate of z gives the conjugate roots, so half the circle with frequencies of both signs is the whole.

    Args:
        present: A₀, shape (n, n).
        delayed: A₁, shape (n, n); A₀ + A₁ is stable.
        below: longer delays do not matter (s).

    Returns:
        The crossing, or None: stable for every delay below.
    """
    best: Crossing | None = None
    pending = [(0.0, np.pi)]
    while pending:
        low, high = pending.pop()
        discs = _Discs(present, delayed, low, high)
        delay, phase, value = discs.foreseen()
        if discs.half <= FORESIGHT and delay < _proven(best, below):
            best = least([best, followed(present, delayed, phase, value)])
        if discs.shortest_delay() >= _proven(best, below):
            continue
        if high - low <= 2 * NARROWEST:
            best = least([best, *discs.touching()])
            continue
        middle = (low + high) / 2
        pending += [(middle, high), (low, middle)]  # the shorter delays first
    return best


def search_all(present: Array, delayed: Array) -> list[Crossing]:
    """All crossings of ẋ = A₀ x(t) + A₁ x(t − τ), none left out, some more than once.

    Args:
        present: A₀, shape (n, n).
        delayed: A₁, shape (n, n); no root stays on the imaginary axis whatever the delay.
    """
    found: list[Crossing] = []
    pending = [(0.0, np.pi)]
    while pending:
        low, high = pending.pop()
        discs = _Discs(present, delayed, low, high)
        if discs.shortest_delay() == np.inf:
            continue
        if high - low <= 2 * NARROWEST:
            found += [followed(present, delayed, at.phase, 1j * at.frequency) or at for at in discs.touching()]
            continue
        middle = (low + high) / 2
        pending += [(middle, high), (low, middle)]
    return found


def _proven(best: Crossing | None, below: float) -> float:
    """The delay (s) below which a crossing would be news."""
    return min(below, best.delay * (1 - PROVEN) if best else np.inf)


class _Discs:
    """Discs that hold the eigenvalues of A₀ + e^{−jθ} A₁ for every θ of an interval."""

    def __init__(self, present: Array, delayed: Array, low: float, high: float) -> None:
        self.low, self.high = low, high
        self.at_rest = AT_REST * float(np.linalg.norm(present) + np.linalg.norm(delayed))
        self.middle, self.half = (low + high) / 2, (high - low) / 2
        z = np.exp(-1j * self.middle)
        self.values, self.vectors = np.linalg.eig(present + z * delayed)
        moved = np.linalg.solve(self.vectors, (-1j * z * delayed) @ self.vectors)
        self.rates = np.diag(moved)
        # |e^{−jθ} − z| ≤ half: each disc's centre moves by its rate, along the circle's tangent and a little off it.
        beside = _scaled_row_sums(np.abs(moved - np.diag(self.rates)), np.abs(self.values.real))
        around = np.abs(self.rates) * self.half**2 / 2 + beside * self.half
        self.real_reach = np.abs(self.rates.real) * self.half + around
        self.imaginary_reach = np.abs(self.rates.imag) * self.half + around

    def shortest_delay(self) -> float:
        """No root reaches the imaginary axis in this interval at a shorter delay (s); infinity where none does."""
        reaches = np.abs(self.values.real) <= self.real_reach
        up = (self.values.imag + self.imaginary_reach)[reaches]
        down = (-self.values.imag + self.imaginary_reach)[reaches]
        delays = [self.low / up[up > 0], (2 * np.pi - self.high) / down[down > 0]]
        return float(np.concatenate(delays).min(initial=np.inf))

    def foreseen(self) -> tuple[float, float, complex]:
        """The shortest delay (s; infinity: none) at which, to first order, a root meets the axis; its phase, the root.

        Only roots that do so within the interval count.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            shift = -self.values.real / self.rates.real
            phase = self.middle + shift
            frequency = self.values.imag + self.rates.imag * shift
            delay = np.where(frequency > 0, phase, 2 * np.pi - phase) / np.abs(frequency)
        delay = np.where(np.abs(shift) <= self.half, delay, np.inf)
        k = int(np.argmin(delay))
        return float(delay[k]), float(phase[k]), 1j * frequency[k]

    def touching(self) -> list[Crossing]:
        """The roots that cannot be told from the imaginary axis."""
        touching = np.flatnonzero(np.abs(self.values.real) <= self.real_reach)
        found = (crossing(self.middle, float(self.values[k].imag), self.vectors[:, k], self.at_rest) for k in touching)
        return [each for each in found if each is not None]


def _scaled_row_sums(matrix: Array, room: Array) -> Array:
    """Row sums of W⁻¹ |matrix| W: Gershgorin's radii hold in any scaling W, and are free to be small where room is.

    The best W is the Perron vector of the matrix over the room of each row; a few steps towards it do.
    """
    if not matrix.any():
        return np.zeros(len(matrix))
    relative = (matrix + matrix.mean() * 1e-3) / np.maximum(room, 1e-6 * room.max())[:, None]
    weights = np.ones(len(matrix))
    for _ in range(10):
        weights = relative @ weights
        weights /= weights.max()
    result: Array = matrix @ weights / weights
    return result
