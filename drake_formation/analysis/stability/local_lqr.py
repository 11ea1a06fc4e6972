"""The local loop of every robot (paper, Theorem 1): Riccati equation, Lyapunov decrease and LQR margins."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.assumptions import local_lqr
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, Array, LinearFormation
from drake_formation.formation.names import robot_name
from drake_formation.parameters import block_parameters

INPUTS = 2
"""Inputs of a robot: force along x and y (N)."""

GUARANTEED_GAIN = 0.5
"""Every LQR stays stable with its input scaled by any factor above this (Safonov and Athans, 1977)."""

GUARANTEED_PHASE_DEG = 60.0
"""Every LQR stays stable with its input delayed in phase by less than this (deg) (Safonov and Athans, 1977)."""

GAINS = 10.0 ** np.arange(0.05, 4.0001, 0.05)
"""Factors above 1 tried in search of a gain margin; their inverses below 1."""

PHASES = np.radians(np.arange(1.0, 180.5))
"""Phases tried in search of a phase margin (rad)."""

FREQUENCIES = 10.0 ** np.linspace(-4.0, 4.0, 400)
"""Frequencies of the return difference, in units of the fastest pole's."""


@dataclass(frozen=True)
class Margins:
    """What a robot's own loop tolerates at its plant's input (force), the other robots left out.

    Guaranteed by theory for every LQR: any factor in (1/2, ∞) or any phase lag below 60°, in both inputs at once, and
    independently in each where R is diagonal (Safonov and Athans, 1977). The numbers are this loop's own, the
    smallest of three cases: both inputs alike, x alone, y alone.

    Attributes:
        lowest_gain: stable down to this factor; 0 where none down to 1e-4 makes it unstable.
        highest_gain: stable up to this factor; None where none up to 1e4 makes it unstable.
        phase_deg: stable up to this phase lag (deg); None where none up to 180° makes it unstable.
        return_difference: least singular value of R^½ (I + K (jωI − A)⁻¹ B) R^-½ over frequency. Kalman's
            inequality says it is at least 1, and the guarantee follows from that.
        independent: R is diagonal, so the guarantee holds for each input by itself.
    """

    lowest_gain: float
    highest_gain: float | None
    phase_deg: float | None
    return_difference: float
    independent: bool

    def to_dict(self) -> dict[str, Any]:
        """Plain values, the guarantee beside this loop's own numbers."""
        return {
            "guaranteed": {
                "lowest_gain": GUARANTEED_GAIN,
                "highest_gain": None,
                "phase_deg": GUARANTEED_PHASE_DEG,
                "inputs": "independently" if self.independent else "both alike",
            },
            "lowest_gain": self.lowest_gain,
            "highest_gain": self.highest_gain,
            "phase_deg": self.phase_deg,
            "return_difference": self.return_difference,
        }


@dataclass(frozen=True)
class LocalLoop:
    """The local LQR of robots of one mass: ẋ = (A − B K) x, with V = xᵀPx decreasing as −xᵀ(Q + KᵀRK)x.

    Attributes:
        robots: which robots, from 1.
        mass: their mass (kg).
        K: gain as the diagram has it (N/m, N s/m), shape (2, 4).
        P: Drake's solution of the Riccati equation, shape (4, 4).
        riccati_residual: ‖AᵀP + PA − PBR⁻¹BᵀP + Q‖ relative to the norms of its terms.
        gain_residual: ‖K − R⁻¹BᵀP‖ relative to ‖K‖: the gain is that of P.
        eigenvalues: of A − B K (1/s), shape (4,).
        decrease: eigenvalues of (A−BK)ᵀP + P(A−BK), ascending, shape (4,); all negative: V falls along every motion.
        lyapunov_residual: how far that matrix is from −(Q + KᵀRK), relative to its norm.
        certified_decay_rate: rate a (1/s) with V̇ ≤ −2 a V; every motion decays at least as exp(−a t).
        margins: at the plant's input.
    """

    robots: tuple[int, ...]
    mass: float
    K: Array
    P: Array
    riccati_residual: float
    gain_residual: float
    eigenvalues: NDArray[np.complex128]
    decrease: Array
    lyapunov_residual: float
    certified_decay_rate: float
    margins: Margins

    @property
    def stable(self) -> bool:
        """Whether the local loop is asymptotically stable (Theorem 1)."""
        return bool(self.eigenvalues.real.max() < 0)

    @property
    def decay_rate(self) -> float:
        """Decay rate of the slowest mode (1/s)."""
        return float(-self.eigenvalues.real.max())

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "robots": list(self.robots),
            "mass_kg": self.mass,
            "stable": self.stable,
            "gain": self.K.tolist(),
            "P": self.P.tolist(),
            "riccati_residual": self.riccati_residual,
            "gain_residual": self.gain_residual,
            "eigenvalues_1_per_s": [[float(s.real), float(s.imag)] for s in self.eigenvalues],
            "decay_rate_1_per_s": self.decay_rate,
            "lyapunov_decrease": self.decrease.tolist(),
            "lyapunov_residual": self.lyapunov_residual,
            "certified_decay_rate_1_per_s": self.certified_decay_rate,
            "margins": self.margins.to_dict(),
        }


def local_loops(formation: LinearFormation) -> tuple[LocalLoop, ...]:
    """The local loop of every robot, one entry for all robots of one mass and weights.

    A − B K and B are read off the linearized diagram and K off its tracking block. Were that K not the one in the
    loop, A = (A − B K) + B K would not be the plant's and the Riccati residual would not vanish.

    Raises:
        IllPosedError: the Riccati equation has no stabilizing solution.
    """
    masses = formation.resolved.masses
    lqrs = [local_lqr(formation.resolved, robot).config for robot in range(formation.robots)]
    kinds = sorted(range(formation.robots), key=lambda robot: (masses[robot], robot))
    firsts = [i for n, i in enumerate(kinds) if not any(_alike(masses, lqrs, i, k) for k in kinds[:n])]
    alike = [np.array([k for k in range(formation.robots) if _alike(masses, lqrs, i, k)]) for i in firsts]
    return tuple(_local_loop(formation, tuple(robots.tolist()), float(masses[robots[0]])) for robots in alike)


def _alike(masses: Array, lqrs: list[Any], one: int, other: int) -> bool:
    """Whether two robots have the same mass and weights."""
    return bool(masses[one] == masses[other]) and bool(lqrs[one] == lqrs[other])


def _local_loop(formation: LinearFormation, robots: tuple[int, ...], mass: float) -> LocalLoop:
    i = robots[0]
    own = slice(STATES * i, STATES * (i + 1))
    closed, b = formation.tracking[own, own], formation.B[own, INPUTS * i : INPUTS * (i + 1)]
    k = block_parameters(formation.resolved)[f"{robot_name(i)}/tracking"][0]
    lqr = local_lqr(formation.resolved, i)
    q, r = lqr.state_cost, lqr.input_cost
    a = closed + b @ k
    p = _riccati(a, b, q, r)
    change, cost = closed.T @ p + p @ closed, q + k.T @ r @ k
    through = np.linalg.solve(r, b.T @ p)
    terms = (a.T @ p, p @ a, -p @ b @ through, q)
    return LocalLoop(
        robots=tuple(robot + 1 for robot in robots),
        mass=mass,
        K=k,
        P=p,
        riccati_residual=_relative(sum(terms, np.zeros_like(q)), *terms),
        gain_residual=_relative(k - through, k),
        eigenvalues=np.linalg.eigvals(closed).astype(complex),
        decrease=np.asarray(np.linalg.eigvalsh((change + change.T) / 2), dtype=float),
        lyapunov_residual=_relative(change + cost, cost),
        certified_decay_rate=_certified_decay(p, cost),
        margins=_margins(a, b, k, r),
    )


def _riccati(a: Array, b: Array, q: Array, r: Array) -> Array:
    """Drake's P."""
    from pydrake.systems.controllers import LinearQuadraticRegulator

    try:
        _, p = LinearQuadraticRegulator(a, b, q, r)
    except (RuntimeError, SystemExit) as error:  # SystemExit is how Drake reports a failed demand
        raise IllPosedError(
            "the Riccati equation of the local LQR has no stabilizing solution: give tracking.Q and tracking.R of "
            "less different sizes, Q with both positions weighted"
        ) from error
    return np.asarray(p)


def _certified_decay(p: Array, cost: Array) -> float:
    """Half the least eigenvalue of P⁻¹(Q + KᵀRK) (1/s)."""
    from scipy.linalg import eigh

    return float(eigh((cost + cost.T) / 2, (p + p.T) / 2, eigvals_only=True)[0] / 2)


def _margins(a: Array, b: Array, k: Array, r: Array) -> Margins:
    inputs = (np.eye(INPUTS), np.diag([1.0, 0.0]), np.diag([0.0, 1.0]))

    def first_loss(factor: Callable[[float], complex], tried: Array) -> float | None:
        """The first of the values at which the loop is lost, at the worst choice of inputs."""

        def scaled(on: Array) -> Callable[[float], NDArray[np.complex128]]:
            return lambda value: a - b @ k - (factor(value) - 1) * b @ on @ k

        losses = [_first_loss(scaled(on), tried) for on in inputs]
        return min((loss for loss in losses if loss is not None), default=None)

    low = first_loss(lambda v: complex(np.exp(-v)), np.log(GAINS))
    high = first_loss(lambda v: complex(np.exp(v)), np.log(GAINS))
    phase = first_loss(lambda v: complex(np.exp(-1j * v)), PHASES)
    return Margins(
        lowest_gain=0.0 if low is None else float(np.exp(-low)),
        highest_gain=None if high is None else float(np.exp(high)),
        phase_deg=None if phase is None else float(np.degrees(phase)),
        return_difference=_return_difference(a, b, k, r),
        independent=bool(np.count_nonzero(r - np.diag(np.diag(r))) == 0),
    )


def _first_loss(matrix: Callable[[float], NDArray[np.complex128]], values: Array) -> float | None:
    """Where a path of matrices that begins stable at 0 first has an eigenvalue on the imaginary axis."""
    from scipy.optimize import brentq

    def abscissa(value: float) -> float:
        return float(np.linalg.eigvals(matrix(value)).real.max())

    before = 0.0
    for value in values:
        if abscissa(value) >= 0:
            return float(brentq(abscissa, before, value, xtol=1e-12))
        before = value
    return None


def _return_difference(a: Array, b: Array, k: Array, r: Array) -> float:
    """The least singular value of R^½ (I + K (jωI − A)⁻¹ B) R^-½ on a grid of frequencies."""
    fastest = np.abs(np.linalg.eigvals(a - b @ k)).max()
    values, vectors = np.linalg.eigh(r)
    root = vectors * np.sqrt(values) @ vectors.T
    resolvents = np.linalg.solve(1j * fastest * FREQUENCIES[:, None, None] * np.eye(len(a)) - a, b)
    difference = root @ (np.eye(INPUTS) + k @ resolvents) @ np.linalg.inv(root)
    return float(np.linalg.svd(difference, compute_uv=False).min())


def _relative(residual: Array, *terms: Array) -> float:
    return float(np.linalg.norm(residual) / max(sum(float(np.linalg.norm(term)) for term in terms), 1e-300))
