"""A local controller of one robot: a law of its tracking error (paper, Eq. 9)."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double

Error = tuple[Scalar, Scalar, Scalar, Scalar]
"""A tracking error ε = x − x_r (m, m/s)."""

TrackingLaw = Callable[..., tuple[Scalar, Scalar]]
"""``law(error, acceleration, *numbers)``: the force (N) of a tracking error ε = x − x_r (m, m/s, four numbers) under a
reference's acceleration (m/s², two numbers), each further argument the list of one group of numbers."""


def tracking_error(state: list[Scalar], reference: list[Scalar], slot: list[Scalar]) -> Error:
    """The tracking error ε = x − x_r of one robot (paper, Eq. 9).

    Args:
        state: x = [q; v] of the robot (m, m/s).
        reference: motion of the formation centre [p; ṗ; p̈] (m, m/s, m/s²), from which x_r = [p + h; ṗ].
        slot: h relative to the formation centre (m).

    Returns:
        Four numbers (m, m/s).
    """
    x, y, vx, vy = state
    rx, ry, rvx, rvy, _, _ = reference
    hx, hy = slot
    return x - rx - hx, y - ry - hy, vx - rvx, vy - rvy


@block_template("TrackingController_", __name__)
def TrackingController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`TrackingController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """The local control u_l of one robot (paper, Eqs. 9-10) by a given law.

        Input ports: ``state`` (size 4) and ``reference``, the motion of the formation centre [p; ṗ; p̈] (m, m/s,
        m/s², size 6), from which the robot's own is x_r = [p + h; ṗ]. Output ports: ``force`` u_l (N, size 2) and
        ``error`` ε = x − x_r (size 4). Parameters: the law's groups of numbers, then the slot h (m).
        """

        def _construct(
            self, law: TrackingLaw, numbers: Sequence[ArrayLike], slot: ArrayLike, *, converter: Any = None
        ) -> None:
            """Make the controller.

            Args:
                law: see :data:`TrackingLaw`; the same function for all robots that one kind of code may serve.
                numbers: what it computes with, by group.
                slot: h_i relative to the formation centre (m), shape (2,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (law, numbers, slot)
            self.kind = law  # all else that it computes with is a parameter
            self._law = law
            self._groups = range(len(numbers))
            self._state = self.DeclareVectorInputPort("state", 4)
            self._reference = self.DeclareVectorInputPort("reference", 6)
            for group in numbers:
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            self.DeclareNumericParameter(BasicVector_[T](slot))
            prerequisites = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            self.DeclareVectorOutputPort("force", 2, self._calc_force, prerequisites)
            self.DeclareVectorOutputPort("error", 4, self._calc_error, prerequisites)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _error(self, context: Any, reference: list[Scalar]) -> Error:
            slot = context.get_numeric_parameter(len(self._groups)).CopyToVector().tolist()
            return tracking_error(self._state.Eval(context).tolist(), reference, slot)

        def _calc_force(self, context: Any, output: Any) -> None:
            reference = self._reference.Eval(context).tolist()
            numbers = [context.get_numeric_parameter(k).CopyToVector().tolist() for k in self._groups]
            output.SetFromVector(np.array(self._law(self._error(context, reference), reference[4:], *numbers)))

        def _calc_error(self, context: Any, output: Any) -> None:
            output.SetFromVector(np.array(self._error(context, self._reference.Eval(context).tolist())))

    return Impl


TrackingController = in_double(TrackingController_)
