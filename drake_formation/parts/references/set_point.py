"""The set-point reference: the centre about which the formation gathers, then the goal."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.systems.templates import block_template, in_double


@block_template("SetPoint_", __name__)
def SetPoint_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The reference as a template over double, AutoDiffXd and Expression; see :class:`SetPoint`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A time-invariant reference per phase, as Theorem 1 of the paper assumes.

        Input port: ``phase`` (0 aggregation, 1 transport). Output port: ``centre``, the motion of the formation
        centre [p; ṗ; p̈] (m, m/s, m/s², size 6), at rest. Parameters: 0, the aggregation centre (m); 1, the goal (m).
        """

        def _construct(self, centre: ArrayLike, goal: ArrayLike, *, converter: Any = None) -> None:
            """Make the reference.

            Args:
                centre: formation centre during aggregation (m), shape (2,).
                goal: formation centre at the end of transport (m), shape (2,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (centre, goal)
            self._zero = T(0.0)
            self._phase = self.DeclareVectorInputPort("phase", 1)
            self.DeclareNumericParameter(BasicVector_[T](centre))
            self.DeclareNumericParameter(BasicVector_[T](goal))
            self.DeclareVectorOutputPort(
                "centre", 6, self._calc_centre, {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_centre(self, context: Any, output: Any) -> None:
            (phase,) = self._phase.Eval(context).tolist()
            cx, cy = context.get_numeric_parameter(0).CopyToVector().tolist()
            gx, gy = context.get_numeric_parameter(1).CopyToVector().tolist()
            zero = self._zero
            output.SetFromVector(np.array([cx + phase * (gx - cx), cy + phase * (gy - cy), zero, zero, zero, zero]))

    return Impl


SetPoint = in_double(SetPoint_)


@part("reference", kind="set_point")
class SetPointReference(Part):
    """The goal itself, from the hand-off on; what the published numbers come from."""

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """Where the formation gathers, and the goal."""
        return formation.centre, formation.goal

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The reference."""
        return SetPoint(*numbers)
