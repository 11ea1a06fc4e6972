"""The plan of least cost within force limits and clear of obstacles: a quadratic program, by Drake and OSQP.

Where there is no such plan, a linear program (by Drake and CLP) says how much is missing for one.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from pydrake.solvers import ClpSolver, MathematicalProgram, OsqpSolver, SolverOptions

from drake_formation.parts.coordination.half_planes import normals
from drake_formation.parts.coordination.prediction import Prediction

Array = NDArray[np.float64]

UNLIMITED = 1e9
"""A force (N) that no plan needs."""
ACCURACY = 1e-5
"""OSQP's tolerance, absolute and relative, before it polishes what it found."""
MOST_ITERATIONS = 20_000
SLIGHT = 1e-3
"""How much of a distance may be missing (m) before there is said to be no plan, as the model is not exact."""


class InfeasibleError(ArithmeticError):
    """There is no plan.

    Attributes:
        robot: which robot cannot keep its distance, from 0.
        obstacle: from which obstacle, from 0.
        missing: how much of it is missing at least (m).
    """

    def __init__(self, robot: int, obstacle: int, missing: float) -> None:
        super().__init__(f"robot {robot + 1} is {missing:.3g} m short of its distance to obstacle {obstacle + 1}")
        self.robot = robot
        self.obstacle = obstacle
        self.missing = missing


@dataclass(frozen=True)
class Constraints:
    """What a plan has to keep: |u| ≤ limits and rows · u ≥ bounds.

    Attributes:
        limits: of every force of the plan (N), infinite for none, shape (2NH,).
        rows: of the half-planes (m/N), shape (H, N, M, 2NH).
        bounds: of each (m), minus infinity for none, shape (H, N, M).
    """

    limits: Array
    rows: Array
    bounds: Array

    @property
    def asked(self) -> NDArray[np.bool_]:
        """The half-planes that some plan within the limits would break, shape (H, N, M)."""
        reached: NDArray[np.bool_] = self.bounds > -(np.abs(self.rows) @ np.minimum(self.limits, UNLIMITED))
        return reached

    def kept_by(self, plan: Array) -> bool:
        """Whether a plan keeps all of them."""
        return bool((np.abs(plan) <= self.limits).all() and (self.rows @ plan >= self.bounds).all())


def constraints(
    predicted: Prediction, now: Array, free_path: Array, guess: Array, limits: Array, obstacles: Array, distance: Array
) -> Constraints:
    """The constraints about the path that a guessed plan leads along.

    Args:
        predicted: the model.
        now: positions of the robots (m), shape (N, 2).
        free_path: of :meth:`Prediction.paths` (m), shape (H, N, 2).
        guess: a plan (N), such as the last one moved on by a sample, shape (2NH,).
        limits: largest force of each robot in x and in y (N), infinite for none, shape (N,).
        obstacles: centre and radius of each (m), shape (M, 3).
        distance: that each robot is to keep from them (m), minus infinity for none, shape (N,).
    """
    path = np.concatenate([now[None], free_path + predicted.shifts @ guess])
    outward = normals(path, obstacles, distance)
    rows = np.einsum("knmi,knij->knmj", outward, predicted.shifts)
    reached = (outward * (free_path[:, :, None] - obstacles[:, :2])).sum(axis=-1)
    bounds = obstacles[:, 2] + distance[:, None] - reached
    return Constraints(np.tile(np.repeat(limits, 2), predicted.horizon), rows, bounds)


def best_plan(predicted: Prediction, errors: Array, kept: Constraints) -> Array:
    """The plan of least cost for some errors (m, m/s), shape (4N,), in N, shape (2NH,).

    Raises:
        InfeasibleError: no plan keeps the constraints.
        RuntimeError: OSQP finds none within force limits alone, which any is.
    """
    plan: Array = predicted.best @ errors
    if kept.kept_by(plan):
        return plan
    found = _solved(predicted, errors, kept)
    if found is not None:
        return found
    if not kept.asked.any():
        raise RuntimeError(f"OSQP finds no plan within force limits in {MOST_ITERATIONS} iterations")
    missing = _missing(kept)
    if missing.max() <= SLIGHT:
        found = _solved(predicted, errors, replace(kept, bounds=kept.bounds - missing - ACCURACY))
        if found is not None:
            return found
    robot, obstacle = np.unravel_index(int(missing.argmax()), missing.shape)
    raise InfeasibleError(int(robot), int(obstacle), float(missing.max()))


def _missing(kept: Constraints) -> Array:
    """By how much each robot's distance to each obstacle has to be shortened (m), in sum the least, shape (N, M)."""
    _, robots, obstacles, forces = kept.rows.shape
    program = MathematicalProgram()
    plan = program.NewContinuousVariables(forces)
    missing = program.NewContinuousVariables(robots * obstacles)
    _limit(program, plan, kept.limits)
    program.AddBoundingBoxConstraint(0.0, np.inf, missing)
    program.AddLinearCost(np.ones(len(missing)), missing)
    asked = kept.asked
    shortened = np.eye(len(missing)).reshape(robots, obstacles, -1)[np.nonzero(asked)[1:]]
    rows = np.hstack([kept.rows[asked], shortened])
    program.AddLinearConstraint(rows, kept.bounds[asked], np.full(len(rows), np.inf), np.concatenate([plan, missing]))
    found: Array = ClpSolver().Solve(program).GetSolution(missing)
    return found.reshape(robots, obstacles)


def _solved(predicted: Prediction, errors: Array, kept: Constraints) -> Array | None:
    """The plan of least cost, or None where OSQP finds none."""
    program = MathematicalProgram()
    plan = program.NewContinuousVariables(len(kept.limits))
    program.AddQuadraticCost(predicted.hessian, predicted.slope @ errors, plan, is_convex=True)
    _limit(program, plan, kept.limits)
    rows = kept.rows[kept.asked]
    if len(rows):
        program.AddLinearConstraint(rows, kept.bounds[kept.asked], np.full(len(rows), np.inf), plan)
    result = OsqpSolver().Solve(program, None, _OPTIONS)
    return np.asarray(result.GetSolution(plan), dtype=float) if result.is_success() else None


def _limit(program: MathematicalProgram, plan: NDArray[np.object_], limits: Array) -> None:
    limited = np.isfinite(limits)
    if limited.any():
        program.AddBoundingBoxConstraint(-limits[limited], limits[limited], plan[limited])


def _options() -> SolverOptions:
    options = SolverOptions()
    values = {
        "eps_abs": ACCURACY,
        "eps_rel": ACCURACY,
        "max_iter": MOST_ITERATIONS,
        "adaptive_rho_interval": 50,  # iterations: a run that is repeated has the same plans, however long they took
        "polishing": 1,
    }
    for name, value in values.items():
        options.SetOption(OsqpSolver.id(), name, value)
    return options


_OPTIONS = _options()
