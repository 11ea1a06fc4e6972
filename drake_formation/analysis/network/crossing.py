"""A root of ẋ = A₀ x(t) + A₁ x(t − τ) that meets the imaginary axis, found by following it there."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

ON_AXIS = 1e-10
"""Real part of a root, relative to the size of the matrices, that is zero."""

ROUNDING = 4 * np.finfo(float).eps
"""The same, as near to zero as it can be computed."""

TOUCHING = 1e-5
"""A root that moves so nearly along the axis, in sine of the angle, touches it and goes back."""

TOGETHER = 1e-7
"""Roots at one point of the axis are this near to it, relative to the size of the matrices."""

AT_REST = 1e-8
"""Frequency, relative to the size of the matrices, that is zero."""

LONGEST_STEP = 0.1
"""Of Newton's method (rad): a root that turns along the axis would throw it far off."""


@dataclass(frozen=True)
class Crossing:
    """A delay at which a root reaches the imaginary axis.

    Attributes:
        delay: τ (s).
        frequency: ω (rad/s), positive: e^{jωt} then solves the equation.
        phase: θ = ωτ (rad), in (0, 2π).
        shape: the vector v of the solution v e^{jωt}, shape (n,).
    """

    delay: float
    frequency: float
    phase: float
    shape: Complex


def least(crossings: Iterable[Crossing | None]) -> Crossing | None:
    """The crossing of least delay among those that there are."""
    found = [crossing for crossing in crossings if crossing is not None]
    return min(found, key=lambda crossing: crossing.delay, default=None)


def directions(present: Array, delayed: Array, meeting: Crossing) -> tuple[int, int]:
    """How many roots go to the right, and how many to the left, through the point of a crossing as the delay grows.

    A root s(τ) that is an eigenvalue λ(θ) of A₀ + e^{−jθ} A₁ at θ = −jsτ has Re(ds/dτ) = ω Re(λ′)/|1 + jλ′τ|²: it
    crosses every time in the same direction, at whichever of the delays θ/ω, (θ + 2π)/ω, …

    Args:
        present: A₀, shape (n, n).
        delayed: A₁, shape (n, n).
        meeting: the crossing.
    """
    z = np.exp(-1j * meeting.phase)
    values, vectors = np.linalg.eig(present + z * delayed)
    size = float(np.linalg.norm(present) + np.linalg.norm(delayed))
    here = np.abs(values - 1j * meeting.frequency) <= TOGETHER * size
    moved = np.linalg.solve(vectors, -1j * z * delayed @ vectors)[np.ix_(here, here)]
    rates = np.linalg.eigvals(moved)
    along = TOUCHING * np.abs(rates)
    return int((rates.real > along).sum()), int((rates.real < -along).sum())


def followed(present: Array, delayed: Array, phase: float, value: complex, steps: int = 60) -> Crossing | None:
    """Follow an eigenvalue of A₀ + e^{−jθ} A₁ to the imaginary axis, by Newton's method.

    Args:
        present: A₀, shape (n, n).
        delayed: A₁, shape (n, n).
        phase: where to begin, θ (rad).
        value: about where the eigenvalue is there.
        steps: at most; a root that only touches the axis takes about thirty, others five.

    Returns:
        The crossing, or None: it leads to none.
    """
    size = float(np.linalg.norm(present) + np.linalg.norm(delayed))
    nearest, best = np.inf, None
    for _ in range(steps):
        z = np.exp(-1j * phase)
        values, vectors = np.linalg.eig(present + z * delayed)
        k = int(np.argmin(np.abs(values - value)))
        if abs(values[k].real) < nearest:
            nearest, best = abs(values[k].real), (phase, float(values[k].imag), vectors[:, k])
        rate = np.linalg.solve(vectors, -1j * z * (delayed @ vectors[:, k]))[k]
        if nearest <= ROUNDING * size or rate.real == 0:
            break
        step = float(np.clip(-values[k].real / rate.real, -LONGEST_STEP, LONGEST_STEP))
        phase, value = phase + step, values[k] + rate * step
    return crossing(*best, AT_REST * size) if best is not None and nearest <= ON_AXIS * size else None


def crossing(phase: float, frequency: float, shape: Complex, at_rest: float = 0.0) -> Crossing | None:
    """The crossing of an eigenvalue jω of A₀ + e^{−jθ} A₁, or of its conjugate.

    There is none without phase, nor up to the frequency taken to be at rest: that takes an infinite delay.
    """
    if frequency < 0:
        phase, frequency, shape = -phase, -frequency, shape.conj()
    phase = phase % (2 * np.pi)
    if frequency <= at_rest or phase == 0:
        return None
    return Crossing(float(phase / frequency), float(frequency), float(phase), shape)
