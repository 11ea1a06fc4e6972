"""δ_v for a damping ratio of the slowest consensus mode.

A mode of displacements φ has mass m = φᵀMφ, damping φᵀDφ + λ δ_v and stiffness k = φᵀKφ, with λ = φᵀ(L ⊗ I)φ, so

    m s² + (d + λ δ_v) s + k = 0,  ζ = (d + λ δ_v) / (2 √(m k)).

For identical robots with isotropic tracking this is exact (λ is the algebraic connectivity and k = k_p + λ δ, plus what
the object's springs add) and δ_v follows at once. Otherwise damping mixes the modes; then ζ is taken from the
eigenvalues of the loop that move as φ does, and δ_v is a root of it.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.agreement import require_agreement
from drake_formation.analysis.errors import IllPosedError
from drake_formation.analysis.force_bound import require_stable
from drake_formation.analysis.linearization import LinearFormation
from drake_formation.analysis.shape import positions, velocities

Array = NDArray[np.float64]

_SORTING = 1e-6
"""Share of the stiffness, and relative distance of two stiffnesses, that is nothing but enough to sort modes by."""


@dataclass(frozen=True)
class VelocityGain:
    """A velocity consensus gain for a damping ratio.

    Attributes:
        damping_ratio: ζ of the slowest consensus mode with this gain; above the one requested only if δ_v is 0.
        requested: ζ asked for.
        delta: δ it was found for (N/m).
        delta_v: δ_v (N s/m), 0 where the mode is damped as much without it.
        without: ζ at δ_v = 0.
        frequency: undamped natural frequency √(k/m) of the mode (rad/s).
        decay_rate: how fast the mode dies out with this gain (1/s).
        laplacian_eigenvalue: λ of the mode; the algebraic connectivity where robots are identical.
        closed_form: whether the quadratic alone gave δ_v; otherwise a root find did.
        least_damping_ratio: the least damping ratio of all modes of the loop with this gain.
    """

    damping_ratio: float
    requested: float
    delta: float
    delta_v: float
    without: float
    frequency: float
    decay_rate: float
    laplacian_eigenvalue: float
    closed_form: bool
    least_damping_ratio: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "damping_ratio": self.damping_ratio,
            "requested_damping_ratio": self.requested,
            "delta_n_per_m": self.delta,
            "delta_v_n_s_per_m": self.delta_v,
            "damping_ratio_without": self.without,
            "frequency_rad_per_s": self.frequency,
            "decay_rate_1_per_s": self.decay_rate,
            "laplacian_eigenvalue": self.laplacian_eigenvalue,
            "closed_form": self.closed_form,
            "least_damping_ratio": self.least_damping_ratio,
        }


@dataclass(frozen=True)
class _SlowestMode:
    """The slowest consensus mode without damping: displacements φ of unit mass, and the numbers of its quadratic."""

    shape: Array
    mass: Array
    damping: float
    stiffness: float
    connectivity: float


def velocity_gain(formation: LinearFormation, *, damping_ratio: float, delta: float | None = None) -> VelocityGain:
    """The smallest δ_v that damps the slowest consensus mode by a ratio.

    The slowest consensus mode is the relative motion with the lowest natural frequency: of the graph's algebraic
    connectivity and, where springs act along the line only, the motion they leave free.

    Args:
        formation: the linearized loop; its own δ_v plays no part.
        damping_ratio: ζ above 0; 1 is critical damping.
        delta: δ (N/m); the scenario's if not given.

    Raises:
        IllPosedError: one robot, a graph that is not connected, a damping ratio that is none, an unstable loop, or
            modes that damping mixes so that no δ_v gives this one the ratio.
    """
    require_agreement(formation, "consensus mode to damp")
    if not (np.isfinite(damping_ratio) and damping_ratio > 0):
        raise IllPosedError(f"a damping ratio is above 0 and finite; {damping_ratio:g} is not")
    delta = formation.delta if delta is None else delta
    require_stable(formation.closed_loop(delta, 0.0), delta, 0.0)
    mode = _slowest_mode(formation, delta)

    def excess(delta_v: float) -> float:
        return _damping(formation.closed_loop(delta, delta_v), mode)[0] - damping_ratio

    without = excess(0.0) + damping_ratio
    by_quadratic = (2 * damping_ratio * np.sqrt(mode.stiffness) - mode.damping) / mode.connectivity
    if without >= damping_ratio * (1 - 1e-12):
        delta_v, closed = 0.0, True
    elif by_quadratic > 0 and abs(excess(by_quadratic)) <= 1e-9 * damping_ratio:
        delta_v, closed = float(by_quadratic), True
    else:
        delta_v, closed = _root(excess, max(by_quadratic, 1e-6), damping_ratio), False
    loop = formation.closed_loop(delta, delta_v)
    reached, decay = _damping(loop, mode)
    values = np.linalg.eigvals(loop)
    return VelocityGain(
        damping_ratio=reached,
        requested=damping_ratio,
        delta=delta,
        delta_v=delta_v,
        without=without,
        frequency=float(np.sqrt(mode.stiffness)),
        decay_rate=decay,
        laplacian_eigenvalue=float(mode.connectivity / np.mean(_content(mode.shape, mode.shape))),
        closed_form=closed,
        least_damping_ratio=float(np.min(-values.real / np.abs(values))),
    )


def _root(excess: Any, guess: float, damping_ratio: float) -> float:
    from scipy.optimize import brentq

    high = guess
    for _ in range(60):
        if excess(high) > 0:
            break
        high *= 2
    else:
        raise IllPosedError(f"no δ_v up to {high:.3g} N s/m damps the slowest consensus mode by {damping_ratio:g}")
    root = float(brentq(excess, 0.0, high, xtol=1e-12 * high, rtol=1e-12))
    if abs(excess(root)) > 1e-6 * damping_ratio:
        raise IllPosedError(
            f"damping mixes the slowest consensus mode with others near δ_v = {root:.4g} N s/m, and its ratio leaps "
            f"past {damping_ratio:g} there; a ratio a little smaller or larger has an answer"
        )
    return root


def _slowest_mode(formation: LinearFormation, delta: float) -> _SlowestMode:
    """Undamped modes (K, M), less the two that consensus resists least (the whole formation moving), the lowest."""
    from scipy.linalg import eigh

    rows, columns = velocities(formation.robots), positions(formation.robots)
    mass: Array = np.asarray(np.linalg.inv(formation.B[rows]), dtype=float)
    loop = formation.closed_loop(delta, 0.0)
    stiffness, damping = -mass @ loop[np.ix_(rows, columns)], -mass @ loop[np.ix_(rows, rows)]
    graph = -mass @ formation.per_delta[np.ix_(rows, columns)]
    # Where nothing else tells relative modes from the common motion, the least bit of consensus does.
    sorting = _SORTING * np.abs(stiffness).max() / np.abs(graph).max() * graph
    squares, shapes = eigh((stiffness + stiffness.T) / 2 + sorting, (mass + mass.T) / 2)
    relative = np.sort(np.argsort(_content(shapes, graph @ shapes) / _content(shapes, shapes))[2:])
    lowest = squares[relative[0]]
    shape = shapes[:, relative[squares[relative] <= lowest * (1 + 2 * _SORTING)]]
    along = [float(np.trace(shape.T @ matrix @ shape) / shape.shape[1]) for matrix in (damping, stiffness, graph)]
    return _SlowestMode(shape, mass, *along)


def _content(left: Array, right: Array) -> Array:
    result: Array = np.sum(left * right, axis=0)
    return result


def _damping(loop: Array, mode: _SlowestMode) -> tuple[float, float]:
    """Damping ratio and decay rate (1/s) of the eigenvalues whose displacements are most of all the mode's."""
    values, vectors = np.linalg.eig(loop)
    moving = vectors[positions(len(loop) // 4)]
    whole = np.einsum("ik,ij,jk->k", moving.conj(), mode.mass, moving).real
    share = np.sum(np.abs(mode.shape.T @ mode.mass @ moving) ** 2, axis=0) / np.maximum(whole, 1e-300)
    pairs = mode.shape.shape[1]
    chosen = values[np.argsort(-share, kind="stable")[: 2 * pairs]]
    ratio = -chosen.real.mean() / np.exp(np.log(np.abs(chosen)).mean())
    return float(ratio), float(-chosen.real.max())
