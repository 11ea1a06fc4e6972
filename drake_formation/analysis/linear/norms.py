"""Norms of a stable linear system ẋ = A x + B w, y = C x: H2 by a Lyapunov equation, H∞ by bisection."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.errors import IllPosedError

Array = NDArray[np.float64]

ON_AXIS = 1e-3
"""Eigenvalues of a Hamiltonian this close to the imaginary axis, relative to their size, are tried as frequencies."""

NEAR_ZERO = 1e-9
"""So are those this close to it relative to the largest; a frequency tried in vain does no harm."""

DECAYS_NOT = 1e-12
"""A mode whose decay is this small, relative to the largest entry of A, does not decay but for rounding."""

UNSEEN = 1e-9
"""An output does not see a mode of which it takes this share."""


class StateSpace(NamedTuple):
    """ẋ = A x + B w, y = C x, with n states, m inputs and p outputs.

    Attributes:
        A: shape (n, n).
        B: shape (n, m).
        C: shape (p, n).
    """

    A: Array
    B: Array
    C: Array


@dataclass(frozen=True)
class ResonancePeak:
    """The largest gain over all frequencies.

    Attributes:
        gain: the H∞ norm, unit of y over unit of w.
        frequency: where it is reached (rad/s).
    """

    gain: float
    frequency: float


def require_stable(A: Array) -> None:
    """Refuse a system that does not come to rest.

    Raises:
        IllPosedError: an eigenvalue of A is not in the open left half plane.
    """
    slowest = float(np.linalg.eigvals(A).real.max())
    if slowest >= 0:
        raise IllPosedError(
            f"the loop is not asymptotically stable: it has an eigenvalue with real part {slowest:.3g} 1/s, where all "
            "must be negative; a disturbance has no bounded effect on it"
        )


def steady_covariance(A: Array, intensity: Array) -> Array:
    """Covariance that a stable system settles at under white noise: P of A P + P Aᵀ + W = 0.

    Args:
        A: state matrix, shape (n, n).
        intensity: W = B Bᵀ for noise of unit intensity, E[w(t) w(τ)ᵀ] = I δ(t − τ); shape (n, n).
    """
    from scipy.linalg import solve_continuous_lyapunov

    solution: Array = solve_continuous_lyapunov(A, -intensity)
    return (solution + solution.T) / 2


def h2_norm(system: StateSpace) -> float:
    """H2 norm √tr(C P Cᵀ): RMS of ‖y‖ under white noise of unit intensity on every input.

    It is also the energy (∫‖y‖² dt)^½ of the responses to unit impulses, one at a time. Modes that do not decay do not
    matter where no output sees them, as the common motion of robots that agree: single integrators in noisy consensus,
    ẋ = −L x + w, have ‖x − mean‖² = Σ 1/(2 λ) over the other eigenvalues of L (Bamieh et al. 2012).

    Raises:
        IllPosedError: an output sees a mode that does not decay.
    """
    system = without_unseen(system)
    require_stable(system.A)
    covariance = steady_covariance(system.A, system.B @ system.B.T)
    return float(np.sqrt(max(np.trace(system.C @ covariance @ system.C.T), 0.0)))


def without_unseen(system: StateSpace) -> StateSpace:
    """A system of the same outputs, without the modes that do not decay and that none of them sees.

    Those span an invariant subspace, which leading Schur vectors are a basis of; what is orthogonal to it goes on by
    itself.

    Returns:
        The smaller system; the same one where every mode decays, or an output sees one that does not.
    """
    from scipy.linalg import schur

    shift = DECAYS_NOT * np.abs(system.A).max(initial=0.0) * np.eye(len(system.A))
    triangular, basis, lasting = schur(system.A + shift, sort="rhp")
    if np.abs(system.C @ basis[:, :lasting]).max(initial=0.0) > UNSEEN * np.abs(system.C).max(initial=0.0):
        return system
    rest = basis[:, lasting:]
    return StateSpace((triangular - shift)[lasting:, lasting:], rest.T @ system.B, system.C @ rest)


def frequency_response(system: StateSpace, frequencies: Array) -> NDArray[np.complex128]:
    """C (jω I − A)⁻¹ B at every frequency (rad/s), shape (frequencies, p, m)."""
    shifted = 1j * np.asarray(frequencies)[:, None, None] * np.eye(len(system.A)) - system.A
    result: NDArray[np.complex128] = system.C @ np.linalg.solve(
        shifted, np.broadcast_to(system.B, (len(shifted), *system.B.shape))
    )
    return result


def gains(response: NDArray[np.complex128]) -> Array:
    """Largest singular value of every matrix of a stack, shape (frequencies,)."""
    smaller = response if response.shape[1] <= response.shape[2] else response.transpose(0, 2, 1)
    gram = smaller @ smaller.conj().transpose(0, 2, 1)
    result: Array = np.sqrt(np.maximum(np.linalg.eigvalsh(gram)[:, -1], 0.0))
    return result


def largest_gain(response: NDArray[np.complex128], frequencies: Array) -> ResonancePeak:
    """The largest gain among those at some frequencies (rad/s)."""
    values = gains(response)
    first = int(np.argmax(values))
    return ResonancePeak(float(values[first]), float(frequencies[first]))


def pole_frequencies(A: Array) -> Array:
    """Where a gain may peak: at rest and at the frequencies of the modes (rad/s), ascending."""
    poles = np.linalg.eigvals(A)
    return np.unique(np.round(np.concatenate([[0.0], np.abs(poles), np.abs(poles.imag)]), 6))


def hinf_norm(system: StateSpace, *, tolerance: float = 1e-6, start: ResonancePeak | None = None) -> ResonancePeak:
    """H∞ norm: the largest ‖y‖ for a sinusoidal input of unit amplitude, over all frequencies and directions.

    A gain γ is a singular value at some frequency exactly where a Hamiltonian matrix has an imaginary eigenvalue
    (Boyd, Balakrishnan, Kabamba 1989). From a gain that is reached, the level just above is tried until it crosses no
    frequency; between two crossings the next gain is taken in the middle (Bruinsma, Steinbuch 1990).

    Args:
        system: a stable system.
        tolerance: the norm is at most this share above the gain returned.
        start: a gain that is reached, by default the largest at the frequencies of the poles. One that another system
            reaches is returned unless this one exceeds it: so the worst of many systems costs little.

    Raises:
        IllPosedError: the system is not stable.
    """
    require_stable(system.A)
    if start is None:
        frequencies = pole_frequencies(system.A)
        start = largest_gain(frequency_response(system, frequencies), frequencies)
    best = start
    while best.gain > 0:
        level = best.gain * (1 + tolerance)
        crossings = _crossings(system, level)
        if not len(crossings):
            break
        # A gain above the level at rest crosses it once only, on the way down.
        edges = np.concatenate([[0.0], crossings])
        tried = np.concatenate([edges, (edges[1:] + edges[:-1]) / 2])
        found = largest_gain(frequency_response(system, tried), tried)
        if found.gain <= level:
            break
        best = found
    return best


def _crossings(system: StateSpace, level: float) -> Array:
    """Frequencies at which a gain may be crossed (rad/s), ascending: too many do no harm, one too few would."""
    forced, seen = system.B @ system.B.T / level, system.C.T @ system.C / level
    values = np.linalg.eigvals(np.block([[system.A, forced], [-seen, -system.A.T]]))
    near = np.abs(values.real) <= ON_AXIS * np.abs(values) + NEAR_ZERO * np.abs(values).max()
    crossings: Array = np.unique(np.abs(values.imag[near]))
    return crossings
