"""The local LQR of a digital controller: designed for a sampling period, and run at it."""

import functools
from collections.abc import Hashable, Iterator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field
from pydrake.systems.controllers import DiscreteTimeLinearQuadraticRegulator

from drake_formation.config.errors import Fault
from drake_formation.config.values import CostMatrix, Period, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part
from drake_formation.parts.tracking.costs import cost_matrix, designed_poles, input_cost_faults, state_cost_faults
from drake_formation.parts.tracking.regulator import Regulator
from drake_formation.parts.tracking.sampled_controller import SampledController

Array = NDArray[np.float64]


def sampled_matrices(mass: float, period: float) -> tuple[Array, Array]:
    """A (4, 4) and B (4, 2) of one robot of a mass (kg) whose force is held for a period (s), exactly."""
    a = np.eye(4)
    a[:2, 2:] = period * np.eye(2)
    b = np.vstack([period**2 / 2 * np.eye(2), period * np.eye(2)]) / mass
    return a, b


def lqr_discrete_gain(mass: float, period: float, state_cost: ArrayLike, input_cost: ArrayLike) -> Array:
    """Gain K of u_k = −K ε_k with the least Σ ε'Qε + u'Ru, by Drake's ``DiscreteTimeLinearQuadraticRegulator``.

    For ever shorter periods T it becomes the gain of the continuous LQR, of whose cost T times that is a sum; a factor
    common to both costs changes no gain (Åström & Wittenmark 1997, Sec. 11.4).

    Args:
        mass: m_i (kg).
        period: T (s).
        state_cost: Q, shape (4, 4), symmetric positive semi-definite with the position weighted.
        input_cost: R, shape (2, 2), symmetric positive definite.

    Returns:
        K, shape (2, 4), in N/m and N s/m.
    """
    costs = (np.asarray(cost, dtype=float) for cost in (state_cost, input_cost))
    gain, _ = DiscreteTimeLinearQuadraticRegulator(*sampled_matrices(mass, period), *costs)
    return np.asarray(gain)


@part("tracking", kind="lqr_discrete")
class LqrDiscrete(Regulator):
    """The LQR of the sampled robot, with its force held over a period."""

    class Config(Section):
        """Its period and weights."""

        period: Period = Field(default=0.1, description="sampling period T (s), counted from time 0; chosen: 0.1")
        Q: CostMatrix = Field(
            default=1.0,
            description="state cost (1/m², s²/m²), 4 x 4: a number times I, a diagonal or a matrix; as lqr's: I",
        )
        R: CostMatrix = Field(
            default=1.0, description="input cost (1/N²), 2 x 2: a number times I, a diagonal or a matrix; as lqr's: I"
        )
        feed_forward: bool = Field(
            default=False, description="add m_i a_r, the force that the reference's acceleration takes; chosen: none"
        )

    designed_from = "Q, R, masses and periods"

    def weight_faults(self) -> Iterator[Fault]:
        """What is wrong with Q and R."""
        yield from state_cost_faults(self.config.Q)
        yield from input_cost_faults(self.config.R)

    def stabilizes(self, mass: float) -> bool:
        """Whether Drake finds a gain."""
        return _stabilizes(mass, self.config.period, self.config.Q, self.config.R)

    def gain(self, mass: float) -> Array:
        """K, shape (2, 4), in N/m and N s/m."""
        config = self.config
        return lqr_discrete_gain(mass, config.period, cost_matrix(config.Q, 4), cost_matrix(config.R, 2))

    def structure(self) -> Hashable:
        """The period, which a block is made with."""
        period: float = self.config.period
        return period

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The controller."""
        return SampledController(self.config.period, *numbers)


@functools.lru_cache(maxsize=1024)
def _stabilizes(mass: float, period: float, state_cost: Any, input_cost: Any) -> bool:
    costs = cost_matrix(state_cost, 4), cost_matrix(input_cost, 2)
    with np.errstate(all="ignore"):
        poles = designed_poles(DiscreteTimeLinearQuadraticRegulator, *sampled_matrices(mass, period), *costs)
    return bool(np.abs(poles).max() < 1)
