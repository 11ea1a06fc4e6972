"""The local controller of one robot: LQR about its reference (paper, Eqs. 9-12)."""

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field
from pydrake.systems.controllers import LinearQuadraticRegulator

from drake_formation.config.errors import Fault
from drake_formation.config.values import CostMatrix, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.controller import TrackingController
from drake_formation.parts.tracking.costs import cost_matrix, designed_poles, input_cost_faults, state_cost_faults
from drake_formation.parts.tracking.regulator import Regulator
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


@part("tracking", kind="lqr")
class Lqr(Regulator):
    """The local LQR about the reference (paper, Eqs. 9-12)."""

    class Config(Section):
        """Its weights."""

        Q: CostMatrix = Field(
            default=1.0,
            description="state cost (1/m², s²/m²), 4 x 4: a number times I, a diagonal or a matrix; published: I",
        )
        R: CostMatrix = Field(
            default=1.0, description="input cost (1/N²), 2 x 2: a number times I, a diagonal or a matrix; published: I"
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

    def weight_faults(self) -> Iterator[Fault]:
        """What is wrong with Q and R."""
        yield from state_cost_faults(self.config.Q)
        yield from input_cost_faults(self.config.R)

    def stabilizes(self, mass: float) -> bool:
        """Whether Drake finds a gain."""
        return _stabilizes(mass, self.config.Q, self.config.R)

    def gain(self, mass: float) -> Array:
        """K_l, shape (2, 4), in N/m and N s/m."""
        return lqr_gain(mass, self.state_cost, self.input_cost)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The controller."""
        *groups, slot = numbers
        return TrackingController(lqr_force, groups, slot)


@functools.lru_cache(maxsize=1024)
def _stabilizes(mass: float, state_cost: Any, input_cost: Any) -> bool:
    state, cost = cost_matrix(state_cost, 4), cost_matrix(input_cost, 2)
    with np.errstate(all="ignore"):
        poles = designed_poles(LinearQuadraticRegulator, *robot_matrices(mass), state, cost)
    return bool(poles.real.max() < 0)
