"""A local controller of one robot that looks at times and holds its force in between."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.parts.tracking.controller import Error, tracking_error
from drake_formation.parts.tracking.lqr import lqr_force
from drake_formation.systems.templates import block_template, in_double


@block_template("SampledController_", __name__)
def SampledController_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The controller as a template over double, AutoDiffXd and Expression; see :class:`SampledController`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """State feedback −K ε of one robot with a zero-order hold.

        Input ports: ``state`` (size 4) and ``reference``, the motion of the formation centre [p; ṗ; p̈] (m, m/s,
        m/s², size 6). Output ports: ``force`` (N, size 2), what was worked out at the last of the times 0, T, 2T, …,
        and ``error`` ε = x − x_r now (size 4). Discrete state: that force, 0 before the first. Parameters: 0, the gain
        K row by row (N/m, N s/m, eight numbers); 1, the mass in the feed-forward (kg), 0 for none; 2, the slot h (m).
        """

        def _construct(
            self, period: float, gain: ArrayLike, inertia: ArrayLike, slot: ArrayLike, *, converter: Any = None
        ) -> None:
            """Make the controller.

            Args:
                period: T (s).
                gain: K, shape (2, 4) (N/m, N s/m).
                inertia: the mass in the feed-forward (kg), 0 for none, shape (1,).
                slot: h_i relative to the formation centre (m), shape (2,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (period, gain, inertia, slot)
            self.kind = period  # all else that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("state", 4)
            self._reference = self.DeclareVectorInputPort("reference", 6)
            for group in (gain, inertia, slot):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(group)))
            held = self.DeclareDiscreteState(2)
            self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._sample)
            self.DeclareStateOutputPort("force", held)
            self.DeclareVectorOutputPort(
                "error", 4, self._calc_error, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _error(self, context: Any) -> Error:
            slot = context.get_numeric_parameter(2).CopyToVector().tolist()
            return tracking_error(self._state.Eval(context).tolist(), self._reference.Eval(context).tolist(), slot)

        def _sample(self, context: Any, held: Any) -> None:
            gain, inertia = (context.get_numeric_parameter(k).CopyToVector().tolist() for k in (0, 1))
            acceleration = self._reference.Eval(context).tolist()[4:]
            held.set_value(np.array(lqr_force(self._error(context), acceleration, gain, inertia)))

        def _calc_error(self, context: Any, output: Any) -> None:
            output.SetFromVector(np.array(self._error(context)))

    return Impl


SampledController = in_double(SampledController_)
