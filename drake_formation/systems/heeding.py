"""What a robot makes of another's state once one of them has failed or they have new slots."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double

STATE = 4


def heard_as(
    own: list[Scalar], told: list[Scalar], change: list[Scalar], displacement: list[Scalar]
) -> tuple[Scalar, ...]:
    """The state that a robot takes for another's.

    While it heeds the other, that is the state told, moved as the two slots have moved apart: what was to be
    h_i − h_j is then to be h'_i − h'_j. While it does not, the other is taken to be just where it should be, and as
    fast as the robot itself, so that consensus between them asks for nothing.

    Args:
        own: [q_i; v_i] (m, m/s).
        told: [q_j; v_j].
        change: 1 while it heeds, else 0; then (h'_i − h'_j) − (h_i − h_j) (m), x and y.
        displacement: h_i − h_j (m), x and y.
    """
    (x, y, vx, vy), (nx, ny, nvx, nvy) = own, told
    (heeded, sx, sy), (hx, hy) = change, displacement
    dropped = 1.0 - heeded
    return (
        heeded * (nx + sx) + dropped * (x - hx),
        heeded * (ny + sy) + dropped * (y - hy),
        heeded * nvx + dropped * vx,
        heeded * nvy + dropped * vy,
    )


@block_template("Heeding_", __name__)
def Heeding_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The block as a template over double, AutoDiffXd and Expression; see :class:`Heeding`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Between a channel and the robot that hears it; see :func:`heard_as`.

        Input ports: ``state``, the robot's own, ``told``, what the channel brings (m, m/s, size 4 each), and
        ``change`` (size 3). Output port: ``heard`` (m, m/s, size 4). Parameter: 0, h_i − h_j (m, two numbers).
        """

        def _construct(self, displacement: ArrayLike, *, converter: Any = None) -> None:
            """Make the block.

            Args:
                displacement: h_i − h_j (m), shape (2,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (displacement,)
            self.kind = ()  # all that it computes with is a parameter
            sizes = {"state": STATE, "told": STATE, "change": 3}
            self._ports = [self.DeclareVectorInputPort(name, size) for name, size in sizes.items()]
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(displacement)))
            read = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            self.DeclareVectorOutputPort("heard", STATE, self._calc_heard, read)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_heard(self, context: Any, output: Any) -> None:
            own, told, change = (port.Eval(context).tolist() for port in self._ports)
            displacement = context.get_numeric_parameter(0).CopyToVector().tolist()
            output.SetFromVector(np.array(heard_as(own, told, change, displacement)))

    return Impl


Heeding = in_double(Heeding_)
