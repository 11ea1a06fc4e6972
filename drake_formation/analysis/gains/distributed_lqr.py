"""Distributed LQR for identical, dynamically decoupled systems (Borrelli and Keviczky, 2008).

For N_L systems ẋ = A x + B u that all see each other, the cost

    ∫ Σ_i (x_iᵀ Q₁ x_i + u_iᵀ R u_i) + Σ_{i<j} (x_i − x_j)ᵀ Q₂ (x_i − x_j) dt

is minimal with u_i = −K₁ x_i − K₂ Σ_j (x_i − x_j). By symmetry its Riccati equation falls apart into two of one
system's size: K₁ belongs to (Q₁, R), and K₁ + N_L K₂ to (Q₁ + N_L Q₂, R) (their Theorem 1, with N_L P̃₂ = P₁ − P₂ for
the solutions P₁ and P₂ of the two). For a graph of more systems whose degrees are at most d, N_L = d + 1 and the gain
is

    K = I ⊗ K₁ + M ⊗ K₂,  M = a L (L the graph's Laplacian),

which is stable if every eigenvalue of M but the zero is above N_L/2 (their Theorem 3: an LQR has infinite gain margin
upwards and one half downwards). Exactly, it is stable if A − B (K₁ + μ K₂) is for every eigenvalue μ of M.

Source: F. Borrelli and T. Keviczky, "Distributed LQR design for identical dynamically decoupled systems", IEEE
Transactions on Automatic Control 53(8), 2008.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.analysis.linear.assumptions import same_lqr
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation
from drake_formation.analysis.linear.well_posed import require_agreement
from drake_formation.parts.tracking.costs import cost_matrix
from drake_formation.parts.tracking.lqr import lqr_gain

Array = NDArray[np.float64]

ISOTROPIC = 1e-9
"""How far K₂ may be from [δ I, δ_v I], relative to its size, to be written as two numbers."""


@dataclass(frozen=True)
class DistributedLqr:
    """A distributed LQR for a formation's graph.

    Attributes:
        K1: local gain, shape (2, 4): the scenario's own K_l, since Q₁ and R are its ``tracking`` weights.
        K2: relative gain for every neighbour, scale included, shape (2, 4).
        systems: N_L, the number of systems of the problem solved: the largest degree plus one.
        relative_cost: Q₂, shape (4, 4).
        scale: a, the weight of the Laplacian in M.
        sufficient_scale: the a above which the theorem alone guarantees stability, N_L/(2 λ₂).
        decay_without_springs: least decay rate of the robots without the object (1/s), from the spectrum; positive.
        decay_with_springs: least decay rate with the object's springs (1/s); the loop is stable if it is positive.
        delta: δ that is this relative gain (N/m), for ``consensus.delta``; None where K2 is not isotropic or negative.
        delta_v: its δ_v (N s/m), likewise.
        cost: the cost of the whole graph's problem after unit hand-off errors (mean over initial states of covariance
            I, without springs), by the distributed gain.
        optimal_cost: the same by the centralised optimum, which may need every robot to hear every other.
    """

    K1: Array
    K2: Array
    systems: int
    relative_cost: Array
    scale: float
    sufficient_scale: float
    decay_without_springs: float
    decay_with_springs: float
    delta: float | None
    delta_v: float | None
    cost: float
    optimal_cost: float

    @property
    def guaranteed(self) -> bool:
        """Whether the theorem's condition holds; if not, stability without springs rests on the exact spectrum."""
        return self.scale > self.sufficient_scale

    @property
    def stable(self) -> bool:
        """Whether the loop with springs is stable, by its eigenvalues."""
        return self.decay_with_springs > 0

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "K1": self.K1.tolist(),
            "K2": self.K2.tolist(),
            "systems": self.systems,
            "relative_cost": self.relative_cost.tolist(),
            "scale": self.scale,
            "sufficient_scale": self.sufficient_scale,
            "guaranteed_by_theorem": self.guaranteed,
            "stable_with_springs": self.stable,
            "decay_without_springs_1_per_s": self.decay_without_springs,
            "decay_with_springs_1_per_s": self.decay_with_springs,
            "delta_n_per_m": self.delta,
            "delta_v_n_s_per_m": self.delta_v,
            "cost": self.cost,
            "optimal_cost": self.optimal_cost,
        }


def distributed_lqr(
    formation: LinearFormation, *, relative_cost: ArrayLike | None = None, scale: float | None = None
) -> DistributedLqr:
    """Design a distributed LQR for a formation's communication graph.

    Q₁ and R are the scenario's ``tracking.Q`` and ``tracking.R``, so K₁ is the local controller that it has already,
    and an isotropic K₂ is written into the scenario as ``consensus.delta`` and ``consensus.delta_v``. The robots are
    decoupled in the theorem but coupled by the object here, so stability with springs is computed apart.

    Args:
        formation: the linearized loop.
        relative_cost: Q₂ as a multiple of I, a diagonal or a matrix, symmetric positive semi-definite; the scenario's
            ``tracking.Q`` if not given.
        scale: a in M = a L; if not given, 1 where the exact spectrum shows that to be stable, else what the theorem
            asks for.

    Raises:
        IllPosedError: one robot, a graph that is not connected, robots of different mass, Q₂ or a that is none, or no
            stable gain without springs.
    """
    plant, force = _plant(formation)
    masses, lqr = formation.resolved.masses, same_lqr(formation.resolved)
    state_cost, input_cost = lqr.state_cost, lqr.input_cost
    between = _relative_cost(state_cost if relative_cost is None else cost_matrix(relative_cost, STATES))
    spectrum = np.linalg.eigvalsh(formation.laplacian)
    systems = round(float(np.diag(formation.laplacian).max())) + 1

    local = lqr_gain(masses[0], state_cost, input_cost)
    joint = lqr_gain(masses[0], state_cost + systems * between, input_cost)
    relative = (joint - local) / systems
    sufficient = systems / (2 * spectrum[1])
    scale = _scale(scale, sufficient, [plant - force @ (local + mu * relative) for mu in spectrum])
    gains = [local + scale * mu * relative for mu in spectrum]
    decay = min(_decay(plant - force @ gain) for gain in gains)
    if decay <= 0:
        raise IllPosedError(
            f"with a = {scale:g} the spectrum of the graph leaves a mode unstable even without springs; the theorem "
            f"asks for more than {sufficient:.6g}"
        )
    coupled = np.kron(formation.laplacian, force @ (scale * relative))
    delta, delta_v = _isotropic(scale * relative)
    costs = [state_cost + mu * between for mu in spectrum]
    optimal = [lqr_gain(masses[0], cost, input_cost) for cost in costs]
    return DistributedLqr(
        K1=local,
        K2=scale * relative,
        systems=systems,
        relative_cost=between,
        scale=scale,
        sufficient_scale=float(sufficient),
        decay_without_springs=decay,
        decay_with_springs=_decay(formation.tracking + formation.springs - coupled),
        delta=delta,
        delta_v=delta_v,
        cost=sum(_cost(plant, force, gain, cost, input_cost) for gain, cost in zip(gains, costs, strict=True)),
        optimal_cost=sum(
            _cost(plant, force, gain, cost, input_cost) for gain, cost in zip(optimal, costs, strict=True)
        ),
    )


def relative_cost_of(formation: LinearFormation, delta: float) -> Array:
    """A Q₂ that weights relative positions alone and whose design has about a given δ (N/m), shape (4, 4).

    With Q₁ = diag(q, q, ·, ·) and R = r I the joint stiffness is √((q + N_L q₂)/r), and it should be k_p + N_L δ.
    """
    lqr = same_lqr(formation.resolved)
    q, r = lqr.state_cost[0, 0], lqr.input_cost[0, 0]
    systems = float(np.diag(formation.laplacian).max()) + 1
    stiffness = np.sqrt(q / r) + systems * delta
    return np.diag([(stiffness**2 * r - q) / systems] * 2 + [0.0, 0.0])


def _plant(formation: LinearFormation) -> tuple[Array, Array]:
    """A and B of the one robot that all are, off the linearized diagram."""
    masses = formation.resolved.masses
    require_agreement(formation, "relative gain to design")
    if np.ptp(masses) > 0:
        raise IllPosedError(
            f"a distributed LQR is for identical robots; robots.mass runs from {masses.min():g} to {masses.max():g} kg"
        )
    force = formation.B[:STATES, :2]
    lqr = same_lqr(formation.resolved)
    local = lqr_gain(masses[0], lqr.state_cost, lqr.input_cost)
    return formation.tracking[:STATES, :STATES] + force @ local, force


def _relative_cost(cost: Array) -> Array:
    if cost.shape != (STATES, STATES) or not np.all(np.isfinite(cost)) or np.abs(cost - cost.T).max() > 0:
        raise IllPosedError("relative_cost is a symmetric 4 x 4 matrix of finite numbers, its diagonal or a number")
    if np.linalg.eigvalsh(cost)[0] < -1e-12 * np.abs(cost).max():
        raise IllPosedError("relative_cost is positive semi-definite; this one rewards disagreement")
    return cost


def _scale(scale: float | None, sufficient: float, loops_at_one: list[Array]) -> float:
    if scale is not None:
        if not (np.isfinite(scale) and scale > 0):
            raise IllPosedError(f"the scale a of M = a L is above 0 and finite; {scale:g} is not")
        return scale
    return 1.0 if all(_decay(loop) > 0 for loop in loops_at_one) else 1.01 * float(sufficient)


def _isotropic(gain: Array) -> tuple[float | None, float | None]:
    """δ and δ_v of [δ I, δ_v I], where a gain is that and a scenario takes it."""
    delta, delta_v = float(gain[0, 0]), float(gain[0, 2])
    plain = np.hstack([delta * np.eye(2), delta_v * np.eye(2)])
    rounding = ISOTROPIC * max(float(np.abs(gain).max()), 1e-300)
    if np.abs(gain - plain).max() > rounding or min(delta, delta_v) < -rounding:
        return None, None
    return max(delta, 0.0), max(delta_v, 0.0)


def _decay(loop: Array) -> float:
    return float(-np.linalg.eigvals(loop).real.max())


def _cost(plant: Array, force: Array, gain: Array, state_cost: Array, input_cost: Array) -> float:
    """The trace of P of what a gain costs from initial states of covariance I."""
    from scipy.linalg import solve_continuous_lyapunov

    loop = plant - force @ gain
    return float(np.trace(solve_continuous_lyapunov(loop.T, -(state_cost + gain.T @ input_cost @ gain))))
