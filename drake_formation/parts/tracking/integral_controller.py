"""A local controller of one robot that remembers: state feedback of its tracking error and of that error's integral."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.values import Positive, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Array, Numbers
from drake_formation.parts.tracking.controller import Error, tracking_error
from drake_formation.parts.tracking.lqr import feed_forward_force
from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double


class Windup(Section):
    """What keeps the integral from growing while the actuators cannot do what it asks for."""

    anti_windup: Positive = Field(
        default=1.0,
        description="time constant T_t (s) with which the integral gives way to what actuators that are not ideal do "
        "not exert of the force asked (back-calculation); chosen: 1",
    )


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


def released(
    error: tuple[Scalar, Scalar], demanded: list[Scalar], applied: list[Scalar], release: list[Scalar]
) -> tuple[Scalar, Scalar]:
    """The rate of z by which it gives way to what actuators do not exert: ż = e + K_z⁺ (u − f)/T_t.

    Back-calculation (Åström & Hägglund 2006, Sec. 3.5): where the actuators exert f of a demand u, the controller's own
    share of what they do not falls away with the time constant T_t.

    Args:
        error: e, of the position (m).
        demanded: u (N).
        applied: f (N).
        release: K_z⁺/T_t row by row, four numbers (m/N).
    """
    ex, ey = error
    over_x, over_y = (u - f for u, f in zip(demanded, applied, strict=True))
    xx, xy, yx, yy = release
    return ex + xx * over_x + xy * over_y, ey + yx * over_x + yy * over_y


@block_template("IntegralController_", __name__)
def IntegralController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`IntegralController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The local control of one robot with integral action.

        Input ports: ``state`` (size 4) and ``reference``, the motion of the formation centre [p; ṗ; p̈] (m, m/s,
        m/s², size 6). Output ports: ``force`` (N, size 2) and ``error`` ε = x − x_r (size 4). Continuous state: z, the
        integral of the position's error (m s, size 2), 0 at the start. Parameters: 0, the gain K row by row (twelve
        numbers); 1, the mass in the feed-forward (kg), 0 for none; 2, the slot h (m). With anti-windup, see
        :func:`released`, also input ports ``demanded`` and ``applied`` (N, size 2), which no output follows at once,
        and parameter 3, the matrix K_z⁺/T_t row by row (m/N, four numbers).
        """

        def _construct(
            self, gain: ArrayLike, inertia: ArrayLike, slot: ArrayLike, *release: ArrayLike, converter: Any = None
        ) -> None:
            """Make the controller.

            Args:
                gain: K of [ε; z], shape (2, 6) (N/m, N s/m, N/(m s)).
                inertia: the mass in the feed-forward (kg), 0 for none, shape (1,).
                slot: h_i relative to the formation centre (m), shape (2,).
                release: K_z⁺/T_t, shape (2, 2) (m/N), for anti-windup; nothing for none.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (gain, inertia, slot, *release)
            self.kind = "integral", len(release)  # all else that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("state", 4)
            self._reference = self.DeclareVectorInputPort("reference", 6)
            seen = {self.input_port_ticket(port.get_index()) for port in (self._state, self._reference)}
            self._limits = [self.DeclareVectorInputPort(name, 2) for name in ("demanded", "applied") if release]
            for group in (gain, inertia, slot, *release):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            self.DeclareContinuousState(2)
            seen |= {self.all_parameters_ticket()}
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
            rate = self._error(context)[:2]
            if self._limits:
                demanded, applied = (port.Eval(context).tolist() for port in self._limits)
                rate = released(rate, demanded, applied, context.get_numeric_parameter(3).CopyToVector().tolist())
            derivatives.SetFromVector(np.array(rate))

    return Impl


IntegralController = in_double(IntegralController_)

IDEAL = "ideal"
"""Kind of actuators that exert all that is asked of them."""


def release_matrix(formation: Formation, robot: int, gain: Array, time: float) -> Numbers:
    """K_z⁺/T_t of a robot's anti-windup (m/N), shape (2, 2); nothing where its actuators are ideal.

    Args:
        formation: the robot's.
        robot: index of the robot, from 0.
        gain: K of [ε; z], shape (2, 6).
        time: T_t (s).
    """
    if formation.parts["actuator"][robot].kind == IDEAL:
        return ()
    return (np.asarray(np.linalg.pinv(gain[:, 4:]) / time, dtype=float),)
