"""The updates of a diagram: when Drake changes discrete state, and refusing what else it may change."""

from collections.abc import Iterator
from types import CodeType

import numpy as np
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import Context, Diagram

from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.wiring import Wiring

UNREPORTED = {
    "DeclarePerStepDiscreteUpdateEvent",
    "DeclarePerStepUnrestrictedUpdateEvent",
    "DeclarePerStepEvent",
    "DeclarePeriodicUnrestrictedUpdateEvent",
    "DeclarePeriodicEvent",
    "DeclareInitializationDiscreteUpdateEvent",
    "DeclareInitializationUnrestrictedUpdateEvent",
    "DeclareInitializationEvent",
}
"""Updates that Drake does not report to Python; a block of Python's that declares one is found by its code."""


class Updates:
    """The periodic discrete updates of a diagram. Drake itself carries them out, between compiled integrations.

    Raises:
        LoweringError: a block has abstract state, witness functions, or updates other than one periodic discrete one.
    """

    def __init__(self, diagram: Diagram, wiring: Wiring) -> None:
        self._diagram = diagram
        self._timings: set[tuple[float, float]] = set()
        for path, block in wiring.blocks.items():
            context = block.CreateDefaultContext()
            timing = block.GetUniquePeriodicDiscreteUpdateAttribute()
            if context.num_abstract_states():
                raise LoweringError(path, "it has abstract state")
            if block.GetWitnessFunctions(context):
                raise LoweringError(path, "it has witness functions")
            if context.num_discrete_state_groups() and not timing:
                raise LoweringError(path, "it has discrete state without a single periodic update of it")
            if declared := UNREPORTED.intersection(_names(type(block))):
                raise LoweringError(path, f"it may change its state at any time ({', '.join(sorted(declared))})")
            if timing:
                self._timings.add((timing.offset_sec(), timing.period_sec()))

    def after(self, time: float, end: float) -> float:
        """The next time after this one at which there is an update, at most the end."""
        times = [end]
        for offset, period in self._timings:
            count = 0 if time < offset else np.floor((time - offset) / period)
            times += [moment for k in range(3) if (moment := offset + (count + k) * period) > time]
        return float(min(times))

    def carry_out(self, context: Context) -> None:
        """Let Drake carry out the updates that are due at the Context's time."""
        if not self._timings:
            return
        simulator = Simulator(self._diagram, context)
        simulator.Initialize()
        simulator.AdvancePendingEvents()


def _names(kind: type) -> Iterator[str]:
    """Every name that the methods of a block's Python classes use."""
    for base in kind.__mro__:
        if base.__module__.startswith("pydrake"):
            continue
        for member in vars(base).values():
            if code := getattr(member, "__code__", None):
                yield from _code_names(code)


def _code_names(code: CodeType) -> Iterator[str]:
    yield from code.co_names
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _code_names(constant)
