"""Consensus error and control effort after a random hand-off, as functions of δ and δ_v with gradients.

After a hand-off with random errors, independent and equally large for all robots, the mean integral of the squared
consensus error and that of the squared control force are

    error = tr(E X)/N,  effort = tr(C X Cᵀ)/N,  A X + X Aᵀ + Σ = 0,

where Σ is the covariance of the hand-off errors, E projects onto consensus errors (paper, Eq. 19) and u = C x. Their
gradient takes the adjoint P, AᵀP + P A + (E + w CᵀC)/N = 0, and the derivatives of the control forces by δ and δ_v,
which Drake's AutoDiffXd carries through the consensus blocks.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from pydrake.autodiffutils import ExtractGradient, ExtractValue, InitializeAutoDiff

from drake_formation.analysis.linear.control_gains import AutoDiffFormation
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation

Array = NDArray[np.float64]

HAND_OFF_ERROR = 0.01
"""Default root mean square of a robot's hand-off error (m)."""


@dataclass(frozen=True)
class HandOffCost:
    """Error and effort after a random hand-off as functions of the gains, with their gradients.

    Attributes:
        formation: the linearized loop.
        hand_off_error_m: root mean square of every robot's hand-off error (m).
    """

    formation: LinearFormation
    hand_off_error_m: float = HAND_OFF_ERROR

    def error_and_effort(self, delta: float, delta_v: float) -> tuple[float, float]:
        """Error (m² s) and effort (N² s).

        Raises:
            IllPosedError: the loop is unstable with these gains.
        """
        covariance, outputs = self._spread(delta, delta_v), self._outputs(delta, delta_v)
        robots = self.formation.robots
        effort = np.sum((outputs @ covariance) * outputs) / robots
        return float(np.sum(self._errors * covariance) / robots), float(effort)

    def cost(self, gains: Array, effort_weight: float) -> tuple[float, Array]:
        """What is minimised, error + effort_weight · effort (m² s), at [δ, δ_v] and its gradient, shape (2,).

        Raises:
            IllPosedError: the loop is unstable with these gains.
        """
        from scipy.linalg import solve_continuous_lyapunov

        loop, outputs = self.formation.closed_loop(*gains), self._outputs(*gains)
        covariance, robots = self._spread(*gains), self.formation.robots
        weights = (self._errors + effort_weight * (outputs.T @ outputs)) / robots
        adjoint = solve_continuous_lyapunov(loop.T, -weights)
        through_motion = 2 * self.formation.B.T @ adjoint @ covariance
        through_force = 2 * effort_weight / robots * outputs @ covariance
        gradient = np.tensordot(self.sensitivities, through_motion + through_force, axes=2)
        return float(np.sum(weights * covariance)), np.asarray(gradient)

    @cached_property
    def hand_off_covariance(self) -> Array:
        """Σ of the hand-off errors (m²), shape (4N, 4N): robots displaced independently, and at rest."""
        one = np.diag([0.5, 0.5, 0.0, 0.0]) * self.hand_off_error_m**2
        return np.asarray(np.kron(np.eye(self.formation.robots), one), dtype=float)

    @cached_property
    def sensitivities(self) -> Array:
        """∂C/∂δ and ∂C/∂δ_v, by AutoDiffXd through the diagram column by column; shape (2, 2N, 4N).

        The consensus law is linear in its gains and in the state, so one evaluation for each unit deviation is exact
        and holds for all gains.
        """
        return self._through_the_diagram[1]

    @cached_property
    def _through_the_diagram(self) -> tuple[Array, Array]:
        """C at the scenario's gains and its derivatives by them."""
        diagram, size = AutoDiffFormation(self.formation), STATES * self.formation.robots
        gains = InitializeAutoDiff([self.formation.delta, self.formation.delta_v]).ravel()
        diagram.set_gains(gains)
        values, gradients = [], []
        for deviation in np.eye(size):
            diagram.set_deviation(deviation)
            forces = diagram.forces()
            values.append(ExtractValue(forces).ravel())
            # Where nobody talks no force depends on the gains, and none has derivatives.
            gradients.append(ExtractGradient(np.append(forces, gains))[: len(forces)])
        return np.stack(values, axis=-1), np.stack(gradients, axis=-1).transpose(1, 0, 2)

    def _outputs(self, delta: float, delta_v: float) -> Array:
        """C with some gains, shape (2N, 4N)."""
        here, per_gain = self._through_the_diagram
        offset = np.array([delta - self.formation.delta, delta_v - self.formation.delta_v])
        result = here + np.tensordot(offset, per_gain, axes=1)
        return np.asarray(result, dtype=float)

    @cached_property
    def _errors(self) -> Array:
        """E, with xᵀEx = Σ_i ‖e_i‖², shape (4N, 4N)."""
        robots = self.formation.robots
        result = np.kron(np.eye(robots) - np.ones((robots, robots)) / robots, np.diag([1.0, 1.0, 0.0, 0.0]))
        return np.asarray(result, dtype=float)

    def _spread(self, delta: float, delta_v: float) -> Array:
        """X, the integral of the covariance of the state, shape (4N, 4N)."""
        from scipy.linalg import solve_continuous_lyapunov

        loop = self.formation.closed_loop(delta, delta_v)
        if np.linalg.eigvals(loop).real.max() >= 0:
            raise IllPosedError(
                f"the loop is unstable with δ = {delta:g} N/m and δ_v = {delta_v:g} N s/m: error and effort have no "
                "end; bounds that leave such gains out, or other tracking weights, give an answer"
            )
        covariance = solve_continuous_lyapunov(loop, -self.hand_off_covariance)
        result: Array = (covariance + covariance.T) / 2
        return result
