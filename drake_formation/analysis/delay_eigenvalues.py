"""The least delay at which ẋ = A₀ x(t) + A₁ x(t − τ) has a root on the imaginary axis: the delay eigenvalue problem."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.errors import IllPosedError

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

LARGEST_PENCIL = 10
"""States up to which the quadratic eigenproblem, of size n², is solved; from there on the search costs less."""

CANDIDATE = 1e-3
"""How far from the unit circle a computed eigenvalue may lie, before refinement, to be one on it; a double one, where a
root only touches the axis, is computed to half the digits."""

ON_AXIS = 1e-10
"""Real part of a root, relative to the size of the matrices, that is zero."""

ROUNDING = 4 * np.finfo(float).eps
"""The same, as near to zero as it can be computed."""

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


def first_crossing(present: Array, delayed: Array, below: float = np.inf) -> Crossing | None:
    """The least delay at which ẋ = A₀ x(t) + A₁ x(t − τ) ceases to be stable.

    v e^{jωt} solves it when (A₀ + z A₁) v = jω v with z = e^{−jωτ}: exactly where, as z runs round the unit circle, an
    eigenvalue of A₀ + z A₁ meets the imaginary axis. Small systems are solved as a quadratic eigenproblem for z
    (:func:`unit_circle_phases`), larger ones by a search that leaves nothing out
    (:mod:`drake_formation.analysis.delay_search`).

    Args:
        present: A₀, what acts at once (1/s), shape (n, n).
        delayed: A₁, what acts a delay later (1/s), shape (n, n).
        below: longer delays do not matter (s); spares the search of larger systems time.

    Returns:
        The crossing of least delay, or None: stable for every delay (below that, if given).

    Raises:
        IllPosedError: it is unstable without any delay.
    """
    require_stable(present + delayed)
    if not delayed.any():
        return None
    if len(present) > LARGEST_PENCIL:
        from drake_formation.analysis.delay_search import search

        return search(present, delayed, below)
    starts = (
        (phase, value) for phase in unit_circle_phases(present, delayed) for value in near_axis(present, delayed, phase)
    )
    return least(followed(present, delayed, phase, value) for phase, value in starts)


def least(crossings: Iterable[Crossing | None]) -> Crossing | None:
    """The crossing of least delay among those that there are."""
    found = [crossing for crossing in crossings if crossing is not None]
    return min(found, key=lambda crossing: crossing.delay, default=None)


def require_stable(A: Array) -> None:
    """Refuse a loop that is unstable, or not asymptotically stable, without any delay.

    Raises:
        IllPosedError: it is.
    """
    abscissa = float(np.linalg.eigvals(A).real.max())
    if abscissa >= -1e-13 * np.abs(A).max():
        raise IllPosedError(
            f"the loop is not stable even without delay (a root at {abscissa:.3g} 1/s): it has no delay margin"
        )


def unit_circle_phases(present: Array, delayed: Array) -> Array:
    """Phases θ in (0, π] at which A₀ + e^{−jθ} A₁ may have an eigenvalue on the imaginary axis.

    The other half of the circle holds the conjugates.

    With V = v v*, (A₀ + z A₁) V + V (A₀ + z A₁)* = 0 on the unit circle, where the conjugate of z is 1/z; stacked, that
    is the quadratic eigenproblem (Chen, Gu and Nett 1995; Jarlebring 2009)

        z² (I ⊗ A₁) + z (I ⊗ A₀ + A₀ ⊗ I) + A₁ ⊗ I,  |z| = 1.

    It is solved for w = (z + 1)/(z − 1) = j cot(θ/2), which takes the circle to the imaginary axis and z = 1, where the
    loop is stable, to infinity: the leading coefficient is then invertible, whatever the rank of A₁.

    Args:
        present: A₀, shape (n, n).
        delayed: A₁, shape (n, n); A₀ + A₁ is stable.

    Returns:
        The phases (rad), a generous choice: to be refined.
    """
    scale = np.linalg.norm(present, 2) + np.linalg.norm(delayed, 2)
    one = np.eye(len(present))
    square, free = np.kron(one, delayed / scale), np.kron(delayed / scale, one)
    linear = np.kron(one, present / scale) + np.kron(present / scale, one)
    lower = np.linalg.solve(square + linear + free, np.hstack([2 * (square - free), square - linear + free]))
    size = len(linear)
    companion = np.block([[-lower], [np.eye(size), np.zeros((size, size))]])
    w = np.linalg.eigvals(companion)
    on_axis = w[(np.abs(w.real) <= CANDIDATE * (1 + np.abs(w))) & (w.imag >= 0)]
    phases: Array = 2 * np.arctan2(1.0, on_axis.imag)
    return phases


def near_axis(present: Array, delayed: Array, phase: float) -> list[complex]:
    """Eigenvalues of A₀ + e^{−jθ} A₁ at a phase θ (rad) that may be meant to lie on the imaginary axis."""
    values = np.linalg.eigvals(present + np.exp(-1j * phase) * delayed)
    return list(values[np.abs(values.real) <= 10 * CANDIDATE * np.abs(values).max()])


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
