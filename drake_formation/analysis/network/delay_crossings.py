"""The least delay at which ẋ = A₀ x(t) + A₁ x(t − τ) has a root on the imaginary axis: the delay eigenvalue problem."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.crossing import Crossing, followed, least
from drake_formation.analysis.network.delay_branch_and_bound import search

Array = NDArray[np.float64]

LARGEST_PENCIL = 10
"""States up to which the quadratic eigenproblem, of size n², is solved; from there on the search costs less."""

CANDIDATE = 1e-3
"""How far from the unit circle a computed eigenvalue may lie, before refinement, to be one on it; a double one, where a
root only touches the axis, is computed to half the digits."""


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
    starts = (
        (phase, value) for phase in unit_circle_phases(present, delayed) for value in near_axis(present, delayed, phase)
    )
    return least(followed(present, delayed, phase, value) for phase, value in starts)


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
