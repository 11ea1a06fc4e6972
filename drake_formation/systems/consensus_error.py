"""The consensus error of every robot: how far it is from agreement with the others (paper, Eqs. 18-20)."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.templates import block_template, in_double


def consensus_errors(positions: Any, slots: Any) -> Any:
    """Consensus error of every robot (paper, Eqs. 18-19): e_i = s_i − mean(s), with s_i = q_i − h_i.

    Args:
        positions: q (m), shape (..., N, 2).
        slots: h (m), shape (N, 2).

    Returns:
        Position part of e (m), shape (..., N, 2).
    """
    agreed = positions - slots
    return agreed - agreed.mean(axis=-2, keepdims=True)


@block_template("ConsensusError_", __name__)
def ConsensusError_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The observer as a template over double, AutoDiffXd and Expression; see :class:`ConsensusError`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """An observer of the whole formation; no robot uses it.

        Input ports: ``state_i`` of every robot (size 4). Output ports: ``error_i`` of every robot, the position
        part of e_i = s_i − mean(s), with s_i = q_i − h_i (m, size 2). Parameter: 0, the slots (m, two a robot).
        """

        def _construct(self, slots: ArrayLike, *, converter: Any = None) -> None:
            """Make the observer.

            Args:
                slots: slots h_i relative to the formation centre (m), shape (N, 2).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (slots,)
            robots = range(1, len(np.asarray(slots)) + 1)
            self._states = [self.DeclareVectorInputPort(f"state_{i}", 4) for i in robots]
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(slots)))
            prerequisites = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            for i in robots:
                self.DeclareVectorOutputPort(f"error_{i}", 2, self._calc_error(i - 1), prerequisites)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_error(self, robot: int) -> Any:
            def calc(context: Any, output: Any) -> None:
                slots = context.get_numeric_parameter(0).CopyToVector().reshape(-1, 2)
                positions = np.array([port.Eval(context)[:2] for port in self._states])
                with np.errstate(invalid="ignore"):  # NumPy warns of arrays of Expression for nothing
                    output.SetFromVector(consensus_errors(positions, slots)[robot])

            return calc

    return Impl


ConsensusError = in_double(ConsensusError_)
