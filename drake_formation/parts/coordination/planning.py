"""The plan of least cost within force limits and clear of obstacles: a quadratic program, by Drake and OSQP."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydrake.solvers import MathematicalProgram, MathematicalProgramResult, OsqpSolver, SolverOptions

from drake_formation.parts.coordination.half_planes import normals
from drake_formation.parts.coordination.prediction import Prediction

Array = NDArray[np.float64]

ACCURACY = 1e-7
"""OSQP's tolerance, absolute and relative."""
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
    """
    plan: Array = predicted.best @ errors
    if kept.kept_by(plan):
        return plan
    gradient = predicted.slope @ errors
    result, plan = _solved(predicted.hessian, gradient, kept, kept.bounds)
    if result.is_success():
        return plan
    missing = _missing(kept)
    robot, obstacle = np.unravel_index(int(missing.argmax()), missing.shape)
    if missing.max() <= SLIGHT:
        result, plan = _solved(predicted.hessian, gradient, kept, kept.bounds - missing - ACCURACY)
        if result.is_success():
            return plan
    raise InfeasibleError(int(robot), int(obstacle), float(missing.max()))


def _missing(kept: Constraints) -> Array:
    """By how much each robot's distance to each obstacle has to be shortened (m), least squares, shape (N, M)."""
    horizon, robots, obstacles, forces = kept.rows.shape
    count = robots * obstacles
    shortened = np.tile(np.eye(count).reshape(1, robots, obstacles, count), (horizon, 1, 1, 1))
    softened = Constraints(
        np.concatenate([kept.limits, np.full(count, np.inf)]),
        np.concatenate([kept.rows, shortened], axis=-1),
        kept.bounds,
    )
    # Next to nothing for the forces, so that one of many plans is the best.
    hessian = np.diag(np.concatenate([np.full(forces, 1e-9), np.full(count, 2.0)]))
    _, solution = _solved(hessian, np.zeros(len(hessian)), softened, kept.bounds)
    missing: Array = np.maximum(solution[forces:], 0.0).reshape(robots, obstacles)
    return missing


def _solved(
    hessian: Array, gradient: Array, kept: Constraints, bounds: Array
) -> tuple[MathematicalProgramResult, Array]:
    program = MathematicalProgram()
    plan = program.NewContinuousVariables(len(gradient))
    program.AddQuadraticCost(hessian, gradient, plan, is_convex=True)
    if limited := np.flatnonzero(np.isfinite(kept.limits)).tolist():
        program.AddBoundingBoxConstraint(-kept.limits[limited], kept.limits[limited], plan[limited])
    asked = np.isfinite(bounds)
    if asked.any():
        rows = kept.rows[asked]
        program.AddLinearConstraint(rows, bounds[asked], np.full(len(rows), np.inf), plan)
    result = OsqpSolver().Solve(program, None, _OPTIONS)
    return result, np.asarray(result.GetSolution(plan), dtype=float)


def _options() -> SolverOptions:
    options = SolverOptions()
    for name, value in (("eps_abs", ACCURACY), ("eps_rel", ACCURACY), ("max_iter", MOST_ITERATIONS), ("polishing", 1)):
        options.SetOption(OsqpSolver.id(), name, value)
    return options


_OPTIONS = _options()
