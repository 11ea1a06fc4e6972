"""A linear state feedback of one robot over its own error and the errors of the robots that it hears."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.parts.roles import STATE
from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double

Array = NDArray[np.float64]


def tracking_error(state: list[Scalar], centre: list[Scalar], target: list[Scalar]) -> list[Scalar]:
    """Deviation ε of a robot from its slot about the formation centre's reference.

    Args:
        state: [q; v] of the robot (m, m/s), four numbers.
        centre: [p; ṗ] of the reference (m, m/s), four numbers.
        target: its slot h (m), two numbers.

    Returns:
        ε (m, m/s), four numbers.
    """
    x, y, vx, vy = state
    px, py, pvx, pvy = centre
    hx, hy = target
    return [x - px - hx, y - py - hy, vx - pvx, vy - pvy]


def feedback_force(errors: list[Scalar], gain: list[Scalar]) -> tuple[Scalar, Scalar]:
    """The force −K ε.

    Args:
        errors: ε of n robots one after another (m, m/s), 4n numbers.
        gain: K row by row (N/m and N s/m), 8n numbers.

    Returns:
        Components of the force (N).
    """
    count = len(errors)
    fx, fy = (sum(k * e for k, e in zip(row, errors, strict=True)) for row in (gain[:count], gain[count:]))
    return -fx, -fy


@block_template("StateFeedback_", __name__)
def StateFeedback_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`StateFeedback`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """u = −(K + phase K_object) ε over the errors of a robot and of those that it hears.

        Input ports: ``state`` (size 4), ``channel_j`` for each robot heard (size 4), ``reference`` (size 6) and, where
        the gain depends on the object, ``phase`` (size 1). Output port: ``force`` (N, size 2). Parameters, all over
        the robot itself and then those heard, n in all: 0, slots h (m, 2n numbers); 1, K row by row (N/m and N s/m, 8n
        numbers); and where the gain depends on the object 2, what that changes of K.
        """

        def _construct(
            self,
            heard: Sequence[int],
            slots: ArrayLike,
            gain: ArrayLike,
            with_object: ArrayLike | None = None,
            *,
            converter: Any = None,
        ) -> None:
            """Make the controller.

            Args:
                heard: numbers of the robots heard (from 1), which name the channel ports.
                slots: h of each (m), shape (n, 2).
                gain: K, shape (2, 4n).
                with_object: K_object, what the object in place adds to K, shape (2, 4n); None where nothing.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (heard, slots, gain, with_object)
            self.kind = with_object is None  # all else that it computes with is a parameter
            self._states = [self.DeclareVectorInputPort("state", STATE)]
            self._states += [self.DeclareVectorInputPort(f"channel_{j}", STATE) for j in heard]
            self._reference = self.DeclareVectorInputPort("reference", 6)
            self._phase = None if with_object is None else self.DeclareVectorInputPort("phase", 1)
            for numbers in (slots, gain, *(() if with_object is None else (with_object,))):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(numbers)))
            self.DeclareVectorOutputPort(
                "force", 2, self._calc_force, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_force(self, context: Any, output: Any) -> None:
            centre = self._reference.Eval(context).tolist()[:STATE]
            slots = context.get_numeric_parameter(0).CopyToVector().reshape(-1, 2).tolist()
            errors = [
                component
                for port, slot in zip(self._states, slots, strict=True)
                for component in tracking_error(port.Eval(context).tolist(), centre, slot)
            ]
            fx, fy = feedback_force(errors, context.get_numeric_parameter(1).CopyToVector().tolist())
            if self._phase:
                (phase,) = self._phase.Eval(context).tolist()
                gx, gy = feedback_force(errors, context.get_numeric_parameter(2).CopyToVector().tolist())
                fx, fy = fx + phase * gx, fy + phase * gy  # += would change an Expression in place
            output.SetFromVector(np.array([fx, fy]))

    return Impl


StateFeedback = in_double(StateFeedback_)


def rows_of(gain: Array, robot: int, robots: Sequence[int]) -> Array:
    """The rows of a robot in a gain of all, (2N, 4N), and of them the columns of some robots: shape (2, 4n)."""
    rows = gain[2 * robot : 2 * robot + 2].reshape(2, -1, STATE)
    return np.ascontiguousarray(rows[:, list(robots)].reshape(2, -1))
