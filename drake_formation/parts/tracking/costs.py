"""The costs of linear quadratic regulators: what they mean, and what is wrong with them."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from drake_formation.config.errors import Fault, shown

Array = NDArray[np.float64]
Design = Callable[[Array, Array, Array, Array], tuple[Array, Array]]
"""``design(A, B, Q, R)``: a gain and the cost to go, as Drake's functions give them."""

_ROUNDING = 1e-12
"""Relative size of what rounding leaves of a zero."""


def cost_matrix(value: ArrayLike, size: int) -> Array:
    """An LQR cost, shape (size, size), from a multiple of the identity, a diagonal or the matrix itself."""
    array = np.asarray(value, dtype=float)
    return array if array.ndim == 2 else np.diag(np.broadcast_to(array, (size,)))


def state_cost_faults(
    value: Any, size: int = 4, resting: slice = slice(0, 2), called: str = "position"
) -> Iterator[Fault]:
    """What is wrong with Q.

    Args:
        value: as written.
        size: number of states.
        resting: the states that keep whatever value they have where nothing moves, A x = 0.
        called: what one of them is.
    """
    path = ("Q",)
    allowed = f"symmetric, positive semi-definite {size} x {size}, weighting both {called}s"
    if faults := list(matrix_faults(path, value, size, allowed)):
        yield from faults
        return
    cost = _scaled(cost_matrix(value, size))
    if not is_semidefinite(cost):
        yield Fault(path, "not positive semi-definite", shown(value), allowed)
    elif np.linalg.eigvalsh(cost[resting, resting])[0] <= 0:
        # At rest such a state stays where it is. If it costs nothing, (A, Q) is not detectable: the mode at 0 stays
        # unseen and no optimal gain moves it (Popov-Belevitch-Hautus).
        yield Fault(path, f"a {called} costs nothing, so the mode at 0 is not detectable", shown(value), allowed)


def input_cost_faults(value: Any) -> Iterator[Fault]:
    """What is wrong with R."""
    path = ("R",)
    allowed = "symmetric, positive definite 2 x 2"
    if faults := list(matrix_faults(path, value, 2, allowed)):
        yield from faults
    elif np.linalg.eigvalsh(_scaled(cost_matrix(value, 2)))[0] <= 0:
        yield Fault(path, "not positive definite", shown(value), allowed)


def designed_poles(design: Design, a: Array, b: Array, state_cost: Array, input_cost: Array) -> NDArray[Any]:
    """Eigenvalues of A − B K with the gain K of a design; not a number where there is none.

    Weights that are sound one by one may still be too far apart for Drake to solve.
    """
    try:
        gain, _ = design(a, b, state_cost, input_cost)
    except (RuntimeError, SystemExit):  # SystemExit is how Drake reports a failed demand
        return np.full(len(a), np.nan)
    closed_loop = a - b @ gain
    finite = bool(np.isfinite(closed_loop).all())
    return np.linalg.eigvals(closed_loop) if finite else np.full(len(a), np.nan)


def matrix_faults(path: tuple[str], value: Any, size: int, allowed: str) -> Iterator[Fault]:
    """Whether a cost has so many rows and columns and is symmetric."""
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


def is_semidefinite(cost: Array) -> bool:
    """Whether a symmetric cost is positive semi-definite, up to rounding."""
    return bool(np.linalg.eigvalsh(_scaled(cost))[0] >= -_ROUNDING)


def _scaled(cost: Array) -> Array:
    """A cost with entries of at most 1: signs of eigenvalues stay, overflows do not."""
    largest = np.abs(cost).max()
    return cost / largest if largest > 0 else cost
