"""The updates of a diagram: when Drake changes discrete state, and refusing what else it may change."""

from collections.abc import Collection
from typing import Any

import numpy as np
from pydrake.systems.framework import Context
from pydrake.systems.primitives import VectorLogSink

from drake_formation.lowering.declared import is_pythons, require_known_events
from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.ticks import Ticks
from drake_formation.lowering.wiring import Wiring


class Updates:
    """The periodic discrete updates of a diagram, carried out by Drake between compiled integrations.

    Args:
        wiring: the diagram's blocks.

    Attributes:
        ticks: the blocks that are updated, by when they are.

    Raises:
        LoweringError: a block has abstract state, abstract parameters or witness functions, or it is one of C++ with
            events other than one periodic discrete update. What blocks of Python's declare is seen when they are
            traced; see :mod:`drake_formation.lowering.declared`.
    """

    def __init__(self, wiring: Wiring) -> None:
        self.ticks: dict[Ticks, list[Any]] = {}
        for path, block in wiring.blocks.items():
            context = block.CreateDefaultContext()
            timing = block.GetUniquePeriodicDiscreteUpdateAttribute()
            if context.num_abstract_states():
                raise LoweringError(path, "it has abstract state")
            if context.num_abstract_parameters():
                raise LoweringError(path, "it has abstract parameters, whose values in a Context are not looked at")
            if block.GetWitnessFunctions(context):
                raise LoweringError(path, "it has witness functions")
            if not is_pythons(block) and not isinstance(block, VectorLogSink):
                require_known_events(path, block, [])
                if context.num_discrete_state_groups() and not timing:
                    raise LoweringError(path, "it has discrete state without a single periodic update of it")
            if timing:
                ticks = Ticks(timing.offset_sec(), timing.period_sec())
                self.ticks.setdefault(ticks, []).append(block)

    def after(self, time: float, end: float, but: Collection[Ticks] = ()) -> float:
        """The next time after this one at which there is an update, except at some ticks; at most the end."""
        return min([end, *(ticks.after(time) for ticks in self.ticks if ticks not in but)])

    def due(self, time: float, but: Collection[Ticks] = ()) -> bool:
        """Whether there is an update at a time, except at some ticks."""
        return any(ticks.is_one(time) for ticks in self.ticks if ticks not in but)

    def carry_out(self, context: Context) -> None:
        """Carry out the updates that are due at the Context's time; all see what was there before any of them."""
        due = [block for ticks, blocks in self.ticks.items() if ticks.is_one(context.get_time()) for block in blocks]
        updated = [(block, _updated(block, block.GetMyContextFromRoot(context))) for block in due]
        for block, groups in updated:
            own = block.GetMyMutableContextFromRoot(context)
            for group, values in enumerate(groups):
                own.SetDiscreteState(group, values)


def _updated(block: Any, context: Context) -> list[np.ndarray[Any, np.dtype[np.float64]]]:
    """The discrete state of a block after its update."""
    values = block.EvalUniquePeriodicDiscreteUpdate(context)
    return [np.array(values.get_vector(k).CopyToVector()) for k in range(values.num_groups())]
