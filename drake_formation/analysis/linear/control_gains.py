"""Control forces as a linear map of the deviation, differentiated by Drake through the diagram in AutoDiffXd."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydrake.autodiffutils import ExtractGradient, InitializeAutoDiff

from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.diagram import build_diagram
from drake_formation.formation.names import robot_name
from drake_formation.parameters import find_block

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ControlGains:
    """u = C x: control forces of all robots for a deviation x from the formation at rest (paper, Eq. 8).

    The consensus law is linear in its gains: ``C(δ, δ_v) = tracking + δ per_delta + δ_v per_delta_v``. The forces of
    the springs are not control and play no part.

    Attributes:
        tracking: the local controllers alone, shape (2N, 4N).
        per_delta: what consensus adds for every N/m of δ, shape (2N, 4N).
        per_delta_v: what consensus adds for every N s/m of δ_v, shape (2N, 4N).
    """

    tracking: Array
    per_delta: Array
    per_delta_v: Array

    def at(self, delta: float, delta_v: float) -> Array:
        """C with some consensus gains (N/m, N s/m), shape (2N, 4N)."""
        result: Array = self.tracking + delta * self.per_delta + delta_v * self.per_delta_v
        return result


class AutoDiffFormation:
    """A formation's diagram in AutoDiffXd, at rest at its goal; gains and state may carry derivatives.

    Args:
        formation: whose diagram to build.
    """

    def __init__(self, formation: LinearFormation) -> None:
        diagram = build_diagram(formation.scenario)
        self.rest = diagram.CreateDefaultContext().get_continuous_state_vector().CopyToVector()
        self.diagram = diagram.ToAutoDiffXd()
        self.context = self.diagram.CreateDefaultContext()
        self._robots = [robot_name(i) for i in range(formation.robots)]

    def set_gains(self, gains: ArrayLike) -> None:
        """Write [δ, δ_v] (N/m, N s/m), with or without derivatives, into the consensus block of every robot."""
        values = np.asarray(gains)
        for robot in self._robots:
            block = find_block(self.diagram, f"{robot}/consensus").GetMyMutableContextFromRoot(self.context)
            block.get_mutable_numeric_parameter(0).SetFromVector(values)

    def set_deviation(self, deviation: ArrayLike) -> None:
        """Write the state at rest plus a deviation, with or without derivatives, shape (4N,)."""
        self.context.SetContinuousState(self.rest + np.asarray(deviation))

    def forces(self) -> NDArray[np.object_]:
        """Control forces of all robots as AutoDiffXd (N), shape (2N,)."""
        ports = [self.diagram.GetOutputPort(f"{robot}_control_force") for robot in self._robots]
        return np.concatenate([port.Eval(self.context) for port in ports])


def control_gains(formation: LinearFormation) -> ControlGains:
    """Differentiate the control forces by the state."""
    diagram = AutoDiffFormation(formation)
    diagram.set_deviation(InitializeAutoDiff(np.zeros(4 * formation.robots)).ravel())

    def gradient(*gains: float) -> Array:
        diagram.set_gains(gains)
        result: Array = ExtractGradient(diagram.forces())
        return result

    tracking = gradient(0.0, 0.0)
    return ControlGains(tracking, gradient(1.0, 0.0) - tracking, gradient(0.0, 1.0) - tracking)
