"""A distributed LQR for the formation's communication graph, judged with the object's springs.

The design is :mod:`drake_formation.parts.coordination.distributed_gains` (Borrelli and Keviczky, 2008): K = I ⊗ K₁ +
M ⊗ K₂ with M = a L.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.analysis.linear.assumptions import same_lqr
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation
from drake_formation.analysis.linear.well_posed import require_agreement
from drake_formation.parts.coordination.distributed_gains import decay_rate, distributed_gains
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
    if scale is not None and not (np.isfinite(scale) and scale > 0):
        raise IllPosedError(f"the scale a of M = a L is above 0 and finite; {scale:g} is not")
    found = distributed_gains(
        masses[0], formation.laplacian, state_cost, input_cost, between, scale=scale, plant=(plant, force)
    )
    if found.decay <= 0:
        raise IllPosedError(
            f"with a = {found.scale:g} the spectrum of the graph leaves a mode unstable even without springs; the "
            f"theorem asks for more than {found.sufficient_scale:.6g}"
        )
    coupled = np.kron(formation.laplacian, force @ found.relative)
    delta, delta_v = _isotropic(found.relative)
    spectrum = np.linalg.eigvalsh(formation.laplacian)
    gains = [found.local + mu * found.relative for mu in spectrum]
    costs = [state_cost + mu * between for mu in spectrum]
    optimal = [lqr_gain(masses[0], cost, input_cost) for cost in costs]
    return DistributedLqr(
        K1=found.local,
        K2=found.relative,
        systems=found.systems,
        relative_cost=between,
        scale=found.scale,
        sufficient_scale=found.sufficient_scale,
        decay_without_springs=found.decay,
        decay_with_springs=decay_rate(formation.tracking + formation.springs - coupled),
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


def _isotropic(gain: Array) -> tuple[float | None, float | None]:
    """δ and δ_v of [δ I, δ_v I], where a gain is that and a scenario takes it."""
    delta, delta_v = float(gain[0, 0]), float(gain[0, 2])
    plain = np.hstack([delta * np.eye(2), delta_v * np.eye(2)])
    rounding = ISOTROPIC * max(float(np.abs(gain).max()), 1e-300)
    if np.abs(gain - plain).max() > rounding or min(delta, delta_v) < -rounding:
        return None, None
    return max(delta, 0.0), max(delta_v, 0.0)


def _cost(plant: Array, force: Array, gain: Array, state_cost: Array, input_cost: Array) -> float:
    """The trace of P of what a gain costs from initial states of covariance I."""
    from scipy.linalg import solve_continuous_lyapunov

    loop = plant - force @ gain
    return float(np.trace(solve_continuous_lyapunov(loop.T, -(state_cost + gain.T @ input_cost @ gain))))
