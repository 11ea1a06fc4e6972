"""The local controller of one robot: LQR about its reference (paper, Eqs. 9-12)."""

import functools
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydrake.systems.controllers import LinearQuadraticRegulator
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double

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


@block_template("TrackingController_", __name__)
def TrackingController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`TrackingController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The local control u_l of one robot (paper, Eqs. 9-10), and optionally what its reference's motion takes.

        Input ports: ``state`` (size 4) and ``reference``, the motion of the formation centre [p; ṗ; p̈] (m, m/s,
        m/s², size 6), from which the robot's own is x_r = [p + h; ṗ]. Output ports: ``force`` u_l + m p̈ (N, size 2)
        and ``error`` ε = x − x_r (size 4). Parameters: 0, the gain K_l row by row; 1, the slot h (m); 2, the mass in
        the feed-forward (kg), 0 for none.
        """

        def _construct(
            self, gain: ArrayLike, slot: ArrayLike, inertia: ArrayLike = (0.0,), *, converter: Any = None
        ) -> None:
            """Make the controller.

            Args:
                gain: K_l, shape (2, 4).
                slot: h_i relative to the formation centre (m), shape (2,).
                inertia: the mass in the feed-forward (kg), 0 for none as in the paper; shape (1,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (gain, slot, inertia)
            self.kind = "tracking"  # all else that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("state", 4)
            self._reference = self.DeclareVectorInputPort("reference", 6)
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(gain)))
            self.DeclareNumericParameter(BasicVector_[T](slot))
            self.DeclareNumericParameter(BasicVector_[T](inertia))
            prerequisites = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            self.DeclareVectorOutputPort("force", 2, self._calc_force, prerequisites)
            self.DeclareVectorOutputPort("error", 4, self._calc_error, prerequisites)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _error(self, context: Any) -> tuple[Scalar, Scalar, Scalar, Scalar]:
            x, y, vx, vy = self._state.Eval(context).tolist()
            rx, ry, rvx, rvy, _, _ = self._reference.Eval(context).tolist()
            hx, hy = context.get_numeric_parameter(1).CopyToVector().tolist()
            return x - rx - hx, y - ry - hy, vx - rvx, vy - rvy

        def _calc_force(self, context: Any, output: Any) -> None:
            gain = context.get_numeric_parameter(0).CopyToVector().tolist()
            (inertia,) = context.get_numeric_parameter(2).CopyToVector().tolist()
            fx, fy = tracking_force(self._error(context), gain)
            ahead_x, ahead_y = feed_forward_force(inertia, *self._reference.Eval(context).tolist()[4:])
            output.SetFromVector(np.array([fx + ahead_x, fy + ahead_y]))

        def _calc_error(self, context: Any, output: Any) -> None:
            output.SetFromVector(np.array(self._error(context)))

    return Impl


TrackingController = in_double(TrackingController_)
