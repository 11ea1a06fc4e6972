"""A local controller of one robot that remembers: state feedback of its tracking error and of that error's integral."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.parts.tracking.controller import Error, tracking_error
from drake_formation.parts.tracking.lqr import feed_forward_force
from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double


def integral_force(error: list[Scalar], gain: list[Scalar]) -> tuple[Scalar, Scalar]:
    """The control u = −K [ε; z] of a tracking error and the integral z of its position.

    Args:
        error: ε = x − x_r (m, m/s) and z (m s), six numbers.
        gain: K row by row, twelve numbers (N/m, N s/m, N/(m s)).

    Returns:
        Components of u (N).
    """
    fx, fy = (sum(k * e for k, e in zip(row, error, strict=True)) for row in (gain[:6], gain[6:]))
    return -fx, -fy


@block_template("IntegralController_", __name__)
def IntegralController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`IntegralController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The local control of one robot with integral action.

        Input ports: ``state`` (size 4) and ``reference``, the motion of the formation centre [p; ṗ; p̈] (m, m/s,
        m/s², size 6). Output ports: ``force`` (N, size 2) and ``error`` ε = x − x_r (size 4). Continuous state: z, the
        integral of the position's error (m s, size 2), 0 at the start. Parameters: 0, the gain K row by row (twelve
        numbers); 1, the mass in the feed-forward (kg), 0 for none; 2, the slot h (m).
        """

        def _construct(self, gain: ArrayLike, inertia: ArrayLike, slot: ArrayLike, *, converter: Any = None) -> None:
            """Make the controller.

            Args:
                gain: K of [ε; z], shape (2, 6) (N/m, N s/m, N/(m s)).
                inertia: the mass in the feed-forward (kg), 0 for none, shape (1,).
                slot: h_i relative to the formation centre (m), shape (2,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (gain, inertia, slot)
            self.kind = "integral"  # all that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("state", 4)
            self._reference = self.DeclareVectorInputPort("reference", 6)
            for group in (gain, inertia, slot):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            self.DeclareContinuousState(2)
            seen = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            # The time keeps the output fresh after a rejected step, as in the plant.
            known = seen | {self.xc_ticket(), self.time_ticket()}
            self.DeclareVectorOutputPort("force", 2, self._calc_force, known)
            self.DeclareVectorOutputPort("error", 4, self._calc_error, seen)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _error(self, context: Any) -> Error:
            slot = context.get_numeric_parameter(2).CopyToVector().tolist()
            return tracking_error(
                self._state.Eval(context).tolist(), self._reference.Eval(context).tolist(), slot
            )  # fmt: skip

        def _calc_force(self, context: Any, output: Any) -> None:
            integral = context.get_continuous_state_vector().CopyToVector().tolist()
            gain = context.get_numeric_parameter(0).CopyToVector().tolist()
            (inertia,) = context.get_numeric_parameter(1).CopyToVector().tolist()
            fx, fy = integral_force([*self._error(context), *integral], gain)
            ahead_x, ahead_y = feed_forward_force(inertia, *self._reference.Eval(context).tolist()[4:])
            output.SetFromVector(np.array([fx + ahead_x, fy + ahead_y]))

        def _calc_error(self, context: Any, output: Any) -> None:
            output.SetFromVector(np.array(self._error(context)))

        def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:  # noqa: N802 - Drake's name
            derivatives.SetFromVector(np.array(self._error(context)[:2]))

    return Impl


IntegralController = in_double(IntegralController_)
