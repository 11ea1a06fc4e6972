"""The LQR of the whole formation as one system: the optimum that decentralized laws are compared with."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.controllers import LinearQuadraticRegulator

from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.linear_formation import formation_matrices, spring_matrix
from drake_formation.parts.coordination.state_feedback import StateFeedback, rows_of
from drake_formation.parts.coordination.weights import FormationControl, Weights, input_cost, state_cost
from drake_formation.parts.part import Numbers
from drake_formation.parts.registry import part

Array = NDArray[np.float64]

KEPT = "centralized_lqr"
"""Where a formation keeps its gains: they are designed once, not once a robot."""


@dataclass(frozen=True)
class CentralizedGains:
    """Gains of all robots' errors to all robots' forces, shape (2N, 4N), in N/m and N s/m.

    Attributes:
        gathering: without the object, as in the aggregation.
        carrying: with its springs, as in the transport.
    """

    gathering: Array
    carrying: Array


def centralized_gains(formation: Formation) -> CentralizedGains:
    """The optimal gains for a formation and its robots' weights, by Drake's ``LinearQuadraticRegulator``.

    Raises:
        One of NO_OPTIMUM: Drake finds no stabilizing gain.
    """
    if KEPT not in formation.kept:
        a, b = formation_matrices(formation.masses)
        costs = state_cost(formation), input_cost(formation)
        gains = [_gain(plant, b, *costs) for plant in (a, a + spring_matrix(formation))]
        formation.kept[KEPT] = CentralizedGains(*gains)
    kept: CentralizedGains = formation.kept[KEPT]
    return kept


def _gain(a: Array, b: Array, q: Array, r: Array) -> Array:
    gain, _ = LinearQuadraticRegulator(a, b, q, r)
    if not np.linalg.eigvals(a - b @ gain).real.max() < 0:
        raise RuntimeError("the gain does not stabilize")
    return np.asarray(gain)


@part("coordination", kind="centralized_lqr")
class CentralizedLqr(FormationControl):
    """The LQR of all robots and the object's linearized springs as one system of 2N inputs, by Drake.

    Each robot applies its own two rows of the gain, which is the whole control: ``tracking.kind`` is ``none``. Without
    springs and relative cost it is as many local LQRs. Source: B. D. O. Anderson and J. B. Moore, "Optimal Control:
    Linear Quadratic Methods", Prentice Hall 1990, Ch. 3.
    """

    Config = Weights
    alike = ("relative_cost",)

    def design(self, formation: Formation) -> object:
        """The gains without and by the object."""
        return centralized_gains(formation)

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """Slots of the robot and of those it hears, and its rows of the gains without and by the object."""
        robots = [owner, *formation.channels.heard[owner]]
        gains = centralized_gains(formation)
        parts = (gains.gathering, gains.carrying - gains.gathering)
        return formation.slots[robots], *(rows_of(gain, owner, robots) for gain in parts)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The controller."""
        return StateFeedback([j + 1 for j in formation.channels.heard[owner]], *numbers)
