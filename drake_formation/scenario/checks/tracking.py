"""LQR weights: whether they give a gain that brings every robot to its set point."""

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np

from drake_formation.scenario import derive
from drake_formation.scenario.errors import Fault, Path, shown
from drake_formation.scenario.schema import Scenario

_ROUNDING = 1e-12
"""Relative size of what rounding leaves of a zero."""


def check(scenario: Scenario) -> Iterator[Fault]:
    """Everything about Q and R."""
    faults = [*_state_cost(scenario.tracking.Q), *_input_cost(scenario.tracking.R)]
    yield from faults
    mass, count = scenario.robots.mass, derive.robot_count(scenario.formation)
    if not faults and not (isinstance(mass, tuple) and len(mass) != count):
        yield from _gain(scenario)


def _state_cost(value: Any) -> Iterator[Fault]:
    path: Path = ("tracking", "Q")
    allowed = "symmetric, positive semi-definite 4 x 4, weighting both positions"
    if faults := list(_matrix(path, value, 4, allowed)):
        yield from faults
        return
    cost = _scaled(derive.cost_matrix(value, 4))
    if np.linalg.eigvalsh(cost)[0] < -_ROUNDING:
        yield Fault(path, "not positive semi-definite", shown(value), allowed)
    elif np.linalg.eigvalsh(cost[:2, :2])[0] <= 0:
        # A robot at rest anywhere is an equilibrium of the plant. If it costs nothing, (A, Q) is not
        # detectable: the mode at 0 stays unseen and no optimal gain moves it (Popov-Belevitch-Hautus).
        yield Fault(path, "a position costs nothing, so the mode at 0 is not detectable", shown(value), allowed)


def _input_cost(value: Any) -> Iterator[Fault]:
    path: Path = ("tracking", "R")
    allowed = "symmetric, positive definite 2 x 2"
    if faults := list(_matrix(path, value, 2, allowed)):
        yield from faults
    elif np.linalg.eigvalsh(_scaled(derive.cost_matrix(value, 2)))[0] <= 0:
        yield Fault(path, "not positive definite", shown(value), allowed)


def _matrix(path: Path, value: Any, size: int, allowed: str) -> Iterator[Fault]:
    """Size and symmetry of a cost."""
    if not isinstance(value, tuple):
        return
    if not (value and isinstance(value[0], tuple)):
        if len(value) != size:
            yield Fault(path, f"a diagonal of {len(value)} entries, not {size}", shown(value), allowed)
        return
    if [len(row) for row in value] != [size] * size:
        yield Fault(path, f"not {size} rows of {size} entries", shown(value), allowed)
        return
    cost = _scaled(np.array(value))
    if np.abs(cost - cost.T).max() > _ROUNDING:
        yield Fault(path, "not symmetric", shown(value), allowed)


def _gain(scenario: Scenario) -> Iterator[Fault]:
    """Weights that are sound one by one may still be too far apart for Drake to solve (paper, Eq. 12)."""
    weights = scenario.tracking
    for mass in np.unique(derive.masses(scenario)):
        if not _stabilizes(float(mass), weights.Q, weights.R):
            message = f"Drake finds no stabilizing gain for a robot of {mass:g} kg"
            yield Fault(("tracking",), message, allowed="Q, R and masses of less different sizes")
            return


@functools.lru_cache(maxsize=1024)
def _stabilizes(mass: float, state_cost: Any, input_cost: Any) -> bool:
    from pydrake.systems.controllers import LinearQuadraticRegulator

    state, cost = derive.cost_matrix(state_cost, 4), derive.cost_matrix(input_cost, 2)
    identity, zero = np.eye(2), np.zeros((2, 2))
    a: Any = np.block([[zero, identity], [zero, zero]])
    with np.errstate(all="ignore"):
        b = np.vstack([zero, identity / mass])
        try:
            gain, _ = LinearQuadraticRegulator(a, b, state, cost)
        except (RuntimeError, SystemExit):  # SystemExit is how Drake reports a failed demand
            return False
        closed_loop = a - b @ gain
    return bool(np.isfinite(closed_loop).all() and np.linalg.eigvals(closed_loop).real.max() < 0)


def _scaled(cost: derive.Array) -> derive.Array:
    """A cost with entries of at most 1: signs of eigenvalues stay, overflows do not."""
    largest = np.abs(cost).max()
    return cost / largest if largest > 0 else cost
