"""The local controller of one robot: LQR about its reference (paper, Eqs. 9-12)."""

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field
from pydrake.systems.controllers import LinearQuadraticRegulator

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import CostMatrix, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.controller import TrackingController
from drake_formation.systems.scalars import Scalar

Array = NDArray[np.float64]
Rows = tuple[tuple[float, ...], ...]


def robot_matrices(mass: float) -> tuple[Array, Array]:
    """A (4, 4) and B (4, 2) of one robot of a mass (kg) in the plane (paper, Eq. 6)."""
    a = np.zeros((4, 4))
    a[:2, 2:] = np.eye(2)
    b = np.zeros((4, 2))
    b[2:] = np.eye(2) / mass
    return a, b


def lqr_gain(mass: float, state_cost: ArrayLike, input_cost: ArrayLike) -> Array:
    """Gain K_l of the local LQR (paper, Eqs. 11-12), from Drake's ``LinearQuadraticRegulator``.

    Args:
        mass: m_i (kg).
        state_cost: Q, shape (4, 4), symmetric positive semi-definite with the position weighted.
        input_cost: R, shape (2, 2), symmetric positive definite.

    Returns:
        K_l, shape (2, 4), in N/m and N s/m.
    """
    costs = (np.asarray(cost, dtype=float) for cost in (state_cost, input_cost))
    return np.array(_known_gain(float(mass), *(tuple(map(tuple, cost.tolist())) for cost in costs)))


@functools.lru_cache(maxsize=1024)
def _known_gain(mass: float, state_cost: Rows, input_cost: Rows) -> Array:
    """A gain for all robots that are alike, and for all runs of them."""
    gain, _ = LinearQuadraticRegulator(*robot_matrices(mass), np.array(state_cost), np.array(input_cost))
    return np.asarray(gain)


def tracking_force(error: tuple[Scalar, Scalar, Scalar, Scalar], gain: list[Scalar]) -> tuple[Scalar, Scalar]:
    """The local control u_l = −K_l ε (paper, Eq. 10).

    The paper's feed-forward −B⁺A x_r is zero for every reference of a point mass, since B⁺A = 0.

    Args:
        error: tracking error ε = x − x_r (m, m/s).
        gain: K_l row by row, eight numbers (N/m, N s/m).

    Returns:
        Components of u_l (N).
    """
    ex, ey, evx, evy = error
    a, b, c, d, e, f, g, h = gain
    return -(a * ex + b * ey + c * evx + d * evy), -(e * ex + f * ey + g * evx + h * evy)


def feed_forward_force(inertia: Scalar, ax: Scalar, ay: Scalar) -> tuple[Scalar, Scalar]:
    """The force m a_r that the reference's own motion takes; the paper's law has none.

    With it, m ε̈ = −K_l ε for a single robot: on its reference it stays there, however that accelerates.

    Args:
        inertia: the mass m_i (kg), or 0 for no feed-forward.
        ax: acceleration a_r of the reference (m/s²), x component.
        ay: its y component (m/s²).

    Returns:
        Components of the force (N).
    """
    return inertia * ax, inertia * ay


def lqr_force(
    error: tuple[Scalar, Scalar, Scalar, Scalar], acceleration: list[Scalar], gain: list[Scalar], inertia: list[Scalar]
) -> tuple[Scalar, Scalar]:
    """The local control, and what the reference's motion takes.

    Args:
        error: tracking error ε = x − x_r (m, m/s).
        acceleration: of the reference (m/s²).
        gain: K_l row by row (N/m, N s/m).
        inertia: the mass in the feed-forward (kg), one number; 0 for none.

    Returns:
        Components of the force (N).
    """
    fx, fy = tracking_force(error, gain)
    ahead_x, ahead_y = feed_forward_force(inertia[0], *acceleration)
    return fx + ahead_x, fy + ahead_y


def cost_matrix(value: ArrayLike, size: int) -> Array:
    """An LQR cost, shape (size, size), from a multiple of the identity, a diagonal or the matrix itself."""
    array = np.asarray(value, dtype=float)
    return array if array.ndim == 2 else np.diag(np.broadcast_to(array, (size,)))


@part("tracking", kind="lqr")
class Lqr(Part):
    """The local LQR about the reference (paper, Eqs. 9-12)."""

    class Config(Section):
        """Its weights."""

        Q: CostMatrix = Field(
            default=1.0, description="state cost, 4 x 4: a number times I, a diagonal or a matrix; published: I"
        )
        R: CostMatrix = Field(
            default=1.0, description="input cost, 2 x 2: a number times I, a diagonal or a matrix; published: I"
        )
        feed_forward: bool = Field(
            default=False, description="add m_i a_r, the force that the reference's acceleration takes; published: none"
        )

    @property
    def state_cost(self) -> Array:
        """Q, shape (4, 4)."""
        return cost_matrix(self.config.Q, 4)

    @property
    def input_cost(self) -> Array:
        """R, shape (2, 2)."""
        return cost_matrix(self.config.R, 2)

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:
        """Whether the weights give a gain that brings the robot to its set point."""
        faults = [*state_cost_faults(self.config.Q), *input_cost_faults(self.config.R)]
        yield from faults
        mass = float(formation.masses[owner])
        # Weights that are sound one by one may still be too far apart for Drake to solve (paper, Eq. 12).
        if not faults and not _stabilizes(mass, self.config.Q, self.config.R):
            message = f"Drake finds no stabilizing gain for a robot of {mass:g} kg"
            yield Fault((), message, allowed="Q, R and masses of less different sizes")

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The gain K_l, the mass in the feed-forward, and the slot."""
        mass = float(formation.masses[owner])
        gain = lqr_gain(mass, self.state_cost, self.input_cost)
        return gain, np.array([mass if self.config.feed_forward else 0.0]), formation.slots[owner]

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The controller."""
        *groups, slot = numbers
        return TrackingController(lqr_force, groups, slot)


_ROUNDING = 1e-12
"""Relative size of what rounding leaves of a zero."""


def state_cost_faults(value: Any) -> Iterator[Fault]:
    """What is wrong with a robot's state cost, given as ``Q``; see :func:`cost_matrix`."""
    path = ("Q",)
    allowed = "symmetric, positive semi-definite 4 x 4, weighting both positions"
    if faults := list(matrix_faults(path, value, 4, allowed)):
        yield from faults
        return
    cost = _scaled(cost_matrix(value, 4))
    if not is_semidefinite(cost):
        yield Fault(path, "not positive semi-definite", shown(value), allowed)
    elif np.linalg.eigvalsh(cost[:2, :2])[0] <= 0:
        # A robot at rest anywhere is an equilibrium of the plant. If it costs nothing, (A, Q) is not
        # detectable: the mode at 0 stays unseen and no optimal gain moves it (Popov-Belevitch-Hautus).
        yield Fault(path, "a position costs nothing, so the mode at 0 is not detectable", shown(value), allowed)


def input_cost_faults(value: Any) -> Iterator[Fault]:
    """What is wrong with a robot's input cost, given as ``R``; see :func:`cost_matrix`."""
    path = ("R",)
    allowed = "symmetric, positive definite 2 x 2"
    if faults := list(matrix_faults(path, value, 2, allowed)):
        yield from faults
    elif np.linalg.eigvalsh(_scaled(cost_matrix(value, 2)))[0] <= 0:
        yield Fault(path, "not positive definite", shown(value), allowed)


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


@functools.lru_cache(maxsize=1024)
def _stabilizes(mass: float, state_cost: Any, input_cost: Any) -> bool:
    state, cost = cost_matrix(state_cost, 4), cost_matrix(input_cost, 2)
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


def is_semidefinite(cost: Array) -> bool:
    """Whether a symmetric cost is positive semi-definite, up to rounding."""
    return bool(np.linalg.eigvalsh(_scaled(cost))[0] >= -_ROUNDING)


def _scaled(cost: Array) -> Array:
    """A cost with entries of at most 1: signs of eigenvalues stay, overflows do not."""
    largest = np.abs(cost).max()
    return cost / largest if largest > 0 else cost
