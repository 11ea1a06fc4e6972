"""The plant of one robot: a mass in the plane, held to its neighbours by the carried object (paper, Eqs. 2-7)."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_, NumericParameterIndex

from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double

SpringLaw = Callable[..., tuple[Scalar, Scalar]]


def hookean_spring_force(
    dx: Scalar, dy: Scalar, dvx: Scalar, dvy: Scalar, stiffness: Scalar, damping: Scalar, hx: Scalar, hy: Scalar
) -> tuple[Scalar, Scalar]:
    """Force F_ij that a spring draws robot i back with, along the line between the robots (paper, Eq. 2).

    F_ij = (k (1 − r/d) + c ḋ/d) (q_i − q_j), with d = ‖q_i − q_j‖ and r = ‖h_i − h_j‖. The damper c ḋ is an
    extension; the paper's springs have none.

    Args:
        dx: position of robot i relative to robot j (m), x component of q_i − q_j.
        dy: its y component (m).
        dvx: velocity of robot i relative to robot j (m/s), x component.
        dvy: its y component (m/s).
        stiffness: k_ij (N/m).
        damping: c_ij (N s/m).
        hx: desired displacement h_i − h_j (m), x component.
        hy: its y component (m).

    Returns:
        Components of F_ij (N); the plant feels −F_ij.
    """
    distance = (dx * dx + dy * dy) ** 0.5
    rest_length = (hx * hx + hy * hy) ** 0.5
    approach = (dx * dvx + dy * dvy) / (distance * distance)
    tension = stiffness * (1.0 - rest_length / distance) + damping * approach
    return tension * dx, tension * dy


def linear_spring_force(
    dx: Scalar, dy: Scalar, dvx: Scalar, dvy: Scalar, stiffness: Scalar, damping: Scalar, hx: Scalar, hy: Scalar
) -> tuple[Scalar, Scalar]:
    """Force F_ij of a spring that resists rotation too (paper, Eqs. 4-7).

    F_ij = k ((q_i − h_i) − (q_j − h_j)) + c (v_i − v_j). Arguments and result as in :func:`hookean_spring_force`.
    """
    return stiffness * (dx - hx) + damping * dvx, stiffness * (dy - hy) + damping * dvy


SPRING_LAWS: dict[str, SpringLaw] = {"hookean": hookean_spring_force, "linear": linear_spring_force}


@block_template("RobotPlant_", __name__)
def RobotPlant_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The plant as a template over double, AutoDiffXd and Expression; see :class:`RobotPlant`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A mass in the plane with one spring port per physically coupled neighbour (paper, Eqs. 2-3).

        Input ports: ``force`` (N, size 2), ``phase`` (0 aggregation, 1 transport: the springs are engaged) and, per
        neighbour j, ``spring_j`` (the neighbour's state, size 4). Output ports: ``state`` x = [q; v] (m, m/s) and
        ``spring_force`` −Σ F_ij (N). Parameters: 0, the mass (kg); 1, for each neighbour in port order the
        stiffness (N/m), the damping (N s/m) and the desired displacement h_i − h_j (m, two numbers).
        """

        def _construct(
            self,
            neighbours: Sequence[int],
            law: str,
            mass: ArrayLike,
            springs: ArrayLike,
            initial_state: ArrayLike,
            *,
            converter: Any = None,
        ) -> None:
            """Make the plant.

            Args:
                neighbours: numbers of the physically coupled robots (from 1), which name the spring ports.
                law: a key of ``SPRING_LAWS``.
                mass: m_i (kg), shape (1,).
                springs: stiffness, damping and displacement of each spring, shape (neighbours, 4).
                initial_state: default state [q; v], shape (4,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (neighbours, law, mass, springs, initial_state)
            self.kind = law  # all else that it computes with is a parameter
            self.law = law
            self._law = SPRING_LAWS[law]
            self._zero = T(0.0)
            self._force = self.DeclareVectorInputPort("force", 2)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self._springs = [self.DeclareVectorInputPort(f"spring_{j}", 4) for j in neighbours]
            self.DeclareNumericParameter(BasicVector_[T](mass))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(springs)))
            self.DeclareContinuousState(BasicVector_[T](initial_state), 2, 2, 0)
            # The time ticket keeps the output fresh: after a rejected step Drake restores the state without
            # telling the caches, but it always tells them the time.
            fresh_state = {self.xc_ticket(), self.time_ticket()}
            self.DeclareVectorOutputPort("state", 4, self._calc_state, fresh_state)
            coupled_ports = {self.input_port_ticket(port.get_index()) for port in [self._phase, *self._springs]}
            self.DeclareVectorOutputPort(
                "spring_force",
                2,
                self._calc_spring_force,
                fresh_state | coupled_ports | {self.numeric_parameter_ticket(NumericParameterIndex(1))},
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_state(self, context: Any, output: Any) -> None:
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector())

        def _calc_spring_force(self, context: Any, output: Any) -> None:
            state = context.get_continuous_state_vector().CopyToVector().tolist()
            output.SetFromVector(np.array(self._spring_force(context, *state)))

        def _spring_force(self, context: Any, x: Scalar, y: Scalar, vx: Scalar, vy: Scalar) -> tuple[Scalar, Scalar]:
            (phase,) = self._phase.Eval(context).tolist()
            springs = context.get_numeric_parameter(1).CopyToVector().reshape(-1, 4).tolist()
            fx = fy = self._zero
            law = self._law
            for port, (k, c, hx, hy) in zip(self._springs, springs, strict=True):
                nx, ny, nvx, nvy = port.Eval(context).tolist()
                gx, gy = law(x - nx, y - ny, vx - nvx, vy - nvy, k, c, hx, hy)
                fx, fy = fx - gx, fy - gy  # -= would change an Expression in place
            return phase * fx, phase * fy

        def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:  # noqa: N802 - Drake's name
            x, y, vx, vy = context.get_continuous_state_vector().CopyToVector().tolist()
            ux, uy = self._force.Eval(context).tolist()
            sx, sy = self._spring_force(context, x, y, vx, vy)
            (mass,) = context.get_numeric_parameter(0).CopyToVector().tolist()
            derivatives.SetFromVector(np.array([vx, vy, (ux + sx) / mass, (uy + sy) / mass]))

    return Impl


RobotPlant = in_double(RobotPlant_)
