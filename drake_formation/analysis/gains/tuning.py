"""δ and δ_v tuned against effort: Drake's ``MathematicalProgram`` with gradients through the diagram.

What is minimised is :class:`drake_formation.analysis.gains.quadratic_cost.HandOffCost`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue
from pydrake.solvers import MathematicalProgram, Solve

from drake_formation.analysis.gains.quadratic_cost import HAND_OFF_ERROR, HandOffCost
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation
from drake_formation.analysis.linear.well_posed import require_agreement

Array = NDArray[np.float64]

LARGEST_DELTA = 1e6
"""Default bound of δ (N/m)."""

LARGEST_DELTA_V = 1e5
"""Default bound of δ_v (N s/m)."""


@dataclass(frozen=True)
class Tuned:
    """Gains and what they cost.

    Attributes:
        delta: δ (N/m).
        delta_v: δ_v (N s/m).
        effort_weight: what a unit of effort costs in units of error (m²/N²).
        error: mean integral of a robot's squared consensus error after the hand-off (m² s).
        effort: mean integral of a robot's squared control force after the hand-off (N² s).
        at_bound: which of "delta" and "delta_v" ended at a bound.
        solver: what minimised the cost.
    """

    delta: float
    delta_v: float
    effort_weight: float
    error: float
    effort: float
    at_bound: tuple[str, ...]
    solver: str

    @property
    def cost(self) -> float:
        """What was minimised, error + effort_weight · effort (m² s)."""
        return self.error + self.effort_weight * self.effort

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "delta_n_per_m": self.delta,
            "delta_v_n_s_per_m": self.delta_v,
            "effort_weight_m2_per_n2": self.effort_weight,
            "error_m2_s": self.error,
            "effort_n2_s": self.effort,
            "at_bound": list(self.at_bound),
            "solver": self.solver,
        }


def tune(
    formation: LinearFormation,
    *,
    effort_weight: float,
    largest_delta: float = LARGEST_DELTA,
    largest_delta_v: float = LARGEST_DELTA_V,
    hand_off_error_m: float = HAND_OFF_ERROR,
    costs: HandOffCost | None = None,
) -> Tuned:
    """The gains that minimise error + effort_weight · effort after a random hand-off.

    For identical robots under a complete graph and without springs this is the LQR of a relative mode with weights
    1 on its displacement and ``effort_weight`` on its force: k_p + N δ = 1/√w and d + N δ_v = √(2m/√w).

    Args:
        formation: the linearized loop; its own gains play no part.
        effort_weight: w, what a unit of effort costs in units of error (m²/N²).
        largest_delta: bound of δ (N/m).
        largest_delta_v: bound of δ_v (N s/m).
        hand_off_error_m: root mean square of every robot's hand-off error (m); scales error and effort alike.
        costs: error and effort of this formation, where they are at hand already.

    Raises:
        IllPosedError: one robot, a graph that is not connected, a weight or a bound that is not positive, an unstable
            loop, or no convergence.
    """
    _require_question(formation, effort_weight, largest_delta, largest_delta_v, hand_off_error_m)
    costs = costs or HandOffCost(formation, hand_off_error_m)
    largest = np.array([largest_delta, largest_delta_v])
    alike, sizes = _as_if_alike(formation, effort_weight)
    start, scale = np.clip(alike, 0.0, largest), np.minimum(sizes, largest)
    unit = costs.cost(start, effort_weight)[0]

    def objective(variables: NDArray[Any]) -> Any:
        differentiated = variables.dtype == object
        numbers = ExtractValue(variables).ravel() if differentiated else variables
        value, gradient = costs.cost(numbers * scale, effort_weight)
        if not differentiated:
            return value / unit
        return AutoDiffXd(value / unit, (gradient * scale / unit) @ ExtractGradient(variables))

    program = MathematicalProgram()
    variables = program.NewContinuousVariables(2, "gains")
    program.AddBoundingBoxConstraint(np.zeros(2), largest / scale, variables)
    program.AddCost(objective, vars=variables)
    solution = Solve(program, start / scale)
    solver = solution.get_solver_id().name()
    if not solution.is_success():
        raise IllPosedError(f"{solver} found no least cost at effort_weight = {effort_weight:g}: other bounds may help")
    gains = np.clip(solution.GetSolution(variables) * scale, 0.0, largest)
    bounded = tuple(
        name
        for name, gain, top, size in zip(("delta", "delta_v"), gains, largest, scale, strict=True)
        if min(gain, top - gain) <= 1e-6 * size
    )
    error, effort = costs.error_and_effort(*gains)
    return Tuned(float(gains[0]), float(gains[1]), effort_weight, error, effort, bounded, solver)


def pareto(
    formation: LinearFormation, effort_weights: Sequence[float], *, hand_off_error_m: float = HAND_OFF_ERROR
) -> tuple[Tuned, ...]:
    """The front of error against effort: :func:`tune` at each weight.

    Raises:
        IllPosedError: as :func:`tune`.
    """
    costs = HandOffCost(formation, hand_off_error_m)
    return tuple(
        tune(formation, effort_weight=weight, hand_off_error_m=hand_off_error_m, costs=costs)
        for weight in effort_weights
    )


def weight_of(formation: LinearFormation, delta: float) -> float:
    """The effort weight (m²/N²) at which a relative mode would be made about as stiff as with some δ (N/m)."""
    stiffness, _, _, connectivity = _typical(formation)
    return float((stiffness + connectivity * delta) ** -2)


def _as_if_alike(formation: LinearFormation, effort_weight: float) -> tuple[Array, Array]:
    """[δ, δ_v] that would be best if all relative modes were alike, and what it would be without the local gains."""
    stiffness, damping, mass, connectivity = _typical(formation)
    wanted = effort_weight**-0.5
    whole = np.array([wanted, np.sqrt(2 * mass * wanted)])
    return (whole - [stiffness, damping]) / connectivity, whole / connectivity


def _typical(formation: LinearFormation) -> tuple[float, float, float, float]:
    """Mean local stiffness (N/m), damping (N s/m) and mass (kg), and mean nonzero Laplacian eigenvalue.

    Raises:
        IllPosedError: a robot has no local stiffness.
    """
    rates = np.arange(len(formation.A)).reshape(-1, STATES)[:, 2:].ravel()
    masses = 1 / np.diag(formation.B[rates])
    stiffness = -masses * formation.tracking[rates, rates - 2]
    damping = -masses * formation.tracking[rates, rates]
    if stiffness.min() <= 0:
        raise IllPosedError("a robot has no local stiffness: without consensus error and effort have no end")
    connectivity = np.trace(formation.laplacian) / max(formation.robots - 1, 1)
    return float(stiffness.mean()), float(damping.mean()), float(masses.mean()), float(connectivity)


def _require_question(formation: LinearFormation, weight: float, delta: float, delta_v: float, error: float) -> None:
    require_agreement(formation, "consensus gain to tune")
    named = {"effort_weight": weight, "largest_delta": delta, "largest_delta_v": delta_v, "hand_off_error_m": error}
    for name, value in named.items():
        if not (np.isfinite(value) and value > 0):
            raise IllPosedError(f"{name} is above 0 and finite; {value:g} is not")
