"""Signals that are constant from one known time to the next, such as what has failed."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.systems.scalars import row_at
from drake_formation.systems.templates import block_template, in_double


@block_template("StagedSignals_", __name__)
def StagedSignals_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The signals as a template over double, AutoDiffXd and Expression; see :class:`StagedSignals`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """Rows of tables, one a stage, by how many switches have been thrown.

        Input ports: for every stage k from 1 on ``reached_k`` (size 1), 1 once its time has come, and 0 before; stage
        0 counts from the beginning. Output ports: one for each table, under its name, with the row of the last stage
        that was reached. Parameters: the tables, row by row.
        """

        def _construct(
            self, stages: int, names: Sequence[str], tables: Sequence[ArrayLike], *, converter: Any = None
        ) -> None:
            """Make the signals.

            Args:
                stages: how many follow on the first.
                names: of the tables.
                tables: a row for each stage, the first included; each of shape (stages + 1, size).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (stages, names, tables)
            self.kind = stages, tuple(names)  # all else that it computes with is a parameter
            self._reached = [self.DeclareVectorInputPort(f"reached_{k + 1}", 1) for k in range(stages)]
            self._bounds = [float(k) for k in range(stages + 1)]
            for index, (name, table) in enumerate(zip(names, tables, strict=True)):
                self.DeclareNumericParameter(BasicVector_[T](np.ravel(table)))
                size = np.size(table) // (stages + 1)
                read = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
                self.DeclareVectorOutputPort(name, size, self._calc_row(index), read)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_row(self, index: int) -> Any:
            def calc(context: Any, output: Any) -> None:
                table = context.get_numeric_parameter(index).CopyToVector().reshape(len(self._bounds), -1)
                thrown = sum((port.Eval(context).tolist()[0] for port in self._reached), 0.0)
                output.SetFromVector(np.array(row_at(thrown, self._bounds, table.tolist())))

            return calc

    return Impl


StagedSignals = in_double(StagedSignals_)
