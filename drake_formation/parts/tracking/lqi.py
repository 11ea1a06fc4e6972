"""LQR with integral action: the local controller that no constant force keeps from its reference."""

import functools
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field
from pydrake.systems.controllers import LinearQuadraticRegulator

from drake_formation.config.errors import Fault
from drake_formation.config.values import CostMatrix
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.costs import cost_matrix, designed_poles, input_cost_faults, state_cost_faults
from drake_formation.parts.tracking.integral_controller import IntegralController, Windup, release_matrix
from drake_formation.parts.tracking.lqr import robot_matrices
from drake_formation.parts.tracking.regulator import Regulator

Array = NDArray[np.float64]

STATES = 6
"""Position, velocity and the integral of the position's error, in the plane."""


def augmented_matrices(mass: float) -> tuple[Array, Array]:
    """A (6, 6) and B (6, 2) of [ε; z], ż = the first two of ε, of one robot of a mass (kg)."""
    a, b = np.zeros((STATES, STATES)), np.zeros((STATES, 2))
    a[:4, :4], b[:4] = robot_matrices(mass)
    a[4:, :2] = np.eye(2)
    return a, b


def lqi_gain(mass: float, state_cost: ArrayLike, input_cost: ArrayLike) -> Array:
    """Gain of the LQR on the augmented system (Young & Willems 1972), by Drake's ``LinearQuadraticRegulator``.

    Args:
        mass: m_i (kg).
        state_cost: Q of [ε; z], shape (6, 6), symmetric positive semi-definite with z weighted.
        input_cost: R, shape (2, 2), symmetric positive definite.

    Returns:
        K, shape (2, 6), in N/m, N s/m and N/(m s).
    """
    costs = (np.asarray(cost, dtype=float) for cost in (state_cost, input_cost))
    gain, _ = LinearQuadraticRegulator(*augmented_matrices(mass), *costs)
    return np.asarray(gain)


@part("tracking", kind="lqi")
class Lqi(Regulator):
    """LQR with integral action on the position's error."""

    class Config(Windup):
        """Its weights."""

        Q: CostMatrix = Field(
            default=(1.0, 1.0, 1.0, 1.0, 0.01, 0.01),
            description="state cost (1/m², s²/m², 1/(m² s²)) of position, velocity and the position's integral, 6 x 6: "
            "a number times I, a diagonal or a matrix; chosen: the paper's I, and 0.01 of the integral",
        )
        R: CostMatrix = Field(
            default=1.0, description="input cost (1/N²), 2 x 2: a number times I, a diagonal or a matrix; chosen: I"
        )
        feed_forward: bool = Field(
            default=False, description="add m_i a_r, the force that the reference's acceleration takes; chosen: none"
        )

    def weight_faults(self) -> Iterator[Fault]:
        """What is wrong with Q and R."""
        yield from state_cost_faults(self.config.Q, STATES, slice(4, 6), "position integral")
        yield from input_cost_faults(self.config.R)

    def stabilizes(self, mass: float) -> bool:
        """Whether Drake finds a gain."""
        return _stabilizes(mass, self.config.Q, self.config.R)

    def gain(self, mass: float) -> Array:
        """K, shape (2, 6), in N/m, N s/m and N/(m s)."""
        return lqi_gain(mass, cost_matrix(self.config.Q, STATES), cost_matrix(self.config.R, 2))

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """The gain, the mass in the feed-forward, the slot, and what its anti-windup takes."""
        gain, *others = super().numbers(formation, owner)
        return gain, *others, *release_matrix(formation, owner, gain, self.config.anti_windup)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The controller."""
        return IntegralController(*numbers)


@functools.lru_cache(maxsize=1024)
def _stabilizes(mass: float, state_cost: Any, input_cost: Any) -> bool:
    costs = cost_matrix(state_cost, STATES), cost_matrix(input_cost, 2)
    with np.errstate(all="ignore"):
        poles = designed_poles(LinearQuadraticRegulator, *augmented_matrices(mass), *costs)
    return bool(poles.real.max() < 0)
