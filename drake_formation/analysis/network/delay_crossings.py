"""Delays at which ẋ = A₀ x(t) + A₁ x(t − τ) has a root on the imaginary axis: the delay eigenvalue problem."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.crossing import ON_AXIS, Crossing, followed, least
from drake_formation.analysis.network.delay_branch_and_bound import search, search_all

Array = NDArray[np.float64]

LARGEST_PENCIL = 10
"""States up to which the quadratic eigenproblem, of size n², is solved; from there on the search costs less."""

CANDIDATE = 1e-3
"""How far from the unit circle a computed eigenvalue may lie, before refinement, to be one on it; a double one, where a
root only touches the axis, is computed to half the digits."""

APART = 1e-6
"""Crossings whose phases and frequencies differ by less, relative to the latter, are one."""

ELSEWHERE = 1.0
"""A phase (rad) at which a root lies on the imaginary axis only by being there at every one."""


def first_crossing(present: Array, delayed: Array, below: float = np.inf) -> Crossing | None:
    """The least delay at which ẋ = A₀ x(t) + A₁ x(t − τ) ceases to be stable.

    v e^{jωt} solves it when (A₀ + z A₁) v = jω v with z = e^{−jωτ}: exactly where, as z runs round the unit circle, an
    eigenvalue of A₀ + z A₁ meets the imaginary axis. Small systems are solved as a quadratic eigenproblem for z
    (:func:`unit_circle_phases`), larger ones by a search that leaves nothing out
    (:mod:`drake_formation.analysis.network.delay_branch_and_bound`).

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
        return search(present, delayed, below)
    return least(_solved(present, delayed))


def all_crossings(present: Array, delayed: Array) -> list[Crossing]:
    """Every phase and frequency at which a root of ẋ = A₀ x(t) + A₁ x(t − τ) meets the imaginary axis.

    Each stands for the delays θ/ω, (θ + 2π)/ω, (θ + 4π)/ω and so on.

    Args:
        present: A₀, what acts at once (1/s), shape (n, n).
        delayed: A₁, what acts a delay later (1/s), shape (n, n); see :func:`stays_on_axis`.
    """
    if not delayed.any():
        return []
    found = _solved(present, delayed) if len(present) <= LARGEST_PENCIL else search_all(present, delayed)
    result: list[Crossing] = []
    for each in sorted(found, key=lambda crossing: crossing.phase):
        if not any(_same(each, other) for other in result):
            result.append(each)
    return result


def _same(one: Crossing, other: Crossing) -> bool:
    turn = (one.phase - other.phase + np.pi) % (2 * np.pi) - np.pi
    return bool(abs(turn) <= APART and abs(one.frequency - other.frequency) <= APART * one.frequency)


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


def stays_on_axis(present: Array, delayed: Array) -> bool:
    """Whether ẋ = A₀ x(t) + A₁ x(t − τ) has a root on the imaginary axis whatever the delay: it is never stable."""
    size = float(np.linalg.norm(present) + np.linalg.norm(delayed))
    anywhere = np.linalg.eigvals(present + np.exp(-1j * ELSEWHERE) * delayed)
    at_rest = np.linalg.eigvals(present + delayed)
    return bool(min(np.abs(anywhere.real).min(), np.abs(at_rest).min()) <= ON_AXIS * size)


def _solved(present: Array, delayed: Array) -> list[Crossing]:
    """The crossings of a small system."""
    starts = (
        (phase, value) for phase in unit_circle_phases(present, delayed) for value in near_axis(present, delayed, phase)
    )
    found = (followed(present, delayed, phase, value) for phase, value in starts)
    return [each for each in found if each is not None]


def unit_circle_phases(present: Array, delayed: Array) -> Array:
    """Phases θ, each once, at which A₀ + e^{−jθ} A₁ may have an eigenvalue on the imaginary axis.

    With V = v v*, (A₀ + z A₁) V + V (A₀ + z A₁)* = 0 on the unit circle, where the conjugate of z is 1/z; stacked, that
    is the quadratic eigenproblem (Chen, Gu and Nett 1995; Jarlebring 2009)

        z² (I ⊗ A₁) + z (I ⊗ A₀ + A₀ ⊗ I) + A₁ ⊗ I,  |z| = 1.

    It is solved for w = (z + c)/(z − c), which takes the circle to the imaginary axis, and a z = c of it, at which no
    two eigenvalues are opposite to each other, to infinity: the leading coefficient is then invertible, whatever the
    rank of A₁. Where the loop is stable without delay c = 1 will do.

    Args:
        present: A₀, shape (n, n).
        delayed: A₁, shape (n, n); see :func:`stays_on_axis`.

    Returns:
        The phases (rad), a generous choice: to be refined.
    """
    scale = np.linalg.norm(present, 2) + np.linalg.norm(delayed, 2)
    stable = np.linalg.eigvals(present + delayed).real.max() < 0
    base = 0.0 if stable else ELSEWHERE
    turned = delayed / scale if stable else np.exp(-1j * base) * delayed / scale
    one = np.eye(len(present))
    square, free = np.kron(one, turned), np.kron(turned.conj(), one)
    linear = np.kron(one, present / scale) + np.kron(present / scale, one)
    lower = np.linalg.solve(square + linear + free, np.hstack([2 * (square - free), square - linear + free]))
    size = len(linear)
    companion = np.block([[-lower], [np.eye(size), np.zeros((size, size))]])
    w = np.linalg.eigvals(companion)
    on_axis = w[np.abs(w.real) <= CANDIDATE * (1 + np.abs(w))]
    phases: Array = base + 2 * np.arctan2(1.0, on_axis.imag)
    return phases


def near_axis(present: Array, delayed: Array, phase: float) -> list[complex]:
    """Eigenvalues of A₀ + e^{−jθ} A₁ at a phase θ (rad) that may be meant to lie on the imaginary axis, or above it."""
    values = np.linalg.eigvals(present + np.exp(-1j * phase) * delayed)
    return list(values[(np.abs(values.real) <= 10 * CANDIDATE * np.abs(values).max()) & (values.imag >= 0)])
