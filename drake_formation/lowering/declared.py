"""Which events a block has, found out without asking its code by name.

Drake reports to Python a block's one periodic discrete update and its witness functions, and nothing else. The rest is
found out as follows.

- A block of Python's that converts to symbols runs its constructor again for that. Whatever declares an event then, the
  block's own code, a helper or a factory, calls Drake's ``LeafSystem``, where it is written down.
- Every block is run by itself in a Simulator: for a moment between its ticks, at its ticks, and over spans without one;
  Drake counts what happens. That shows the events of blocks of C++, and what was declared on a block afterwards.
- Of a block that cannot be run so nothing is known, and it is refused.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from pydrake.symbolic import Expression
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import EventStatus, LeafSystem_, PortDataType

from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.ticks import Ticks

CARRIED_OUT = "DeclarePeriodicDiscreteUpdateEvent"
"""What a compiled run does as Drake does, given that the block has one period and offset."""

INERT = {"DeclareForcedDiscreteUpdateEvent", "DeclareForcedPublishEvent", "DeclareForcedUnrestrictedUpdateEvent"}
"""What a Simulator never does by itself."""

DECLARATIONS = tuple(
    name for name in dir(LeafSystem_[Expression]) if name.startswith("Declare") and name.endswith("Event")
)
"""All of Drake's ways to declare an event."""

HORIZON = 1e6
"""An event whose first time is later (s) is not looked for in blocks that have no periodic update."""
WINDOWS = 64
"""Nor is one later than so many periods of the update, in blocks that have one."""
BETWEEN = 0.381966
"""A share of a period, and a time (s), that hardly any period divides."""
INPUT, APART = 0.5, 0.0618034
"""The first number that a block's inputs have where it runs by itself; how far the next one is, in a port and from
port to port."""

Counts = tuple[int, int, int]
"""Publish events, discrete updates and unrestricted updates that a Simulator has carried out."""


@contextmanager
def recorded() -> Iterator[list[str]]:
    """Write down which events symbolic blocks declare meanwhile: names of ``LeafSystem``'s functions.

    It stands in for functions of a class of Drake's, so one thread at a time may do it; what others do is not written
    down.
    """
    names: list[str] = []
    thread = threading.get_ident()
    base = LeafSystem_[Expression]
    originals = {name: getattr(base, name) for name in DECLARATIONS}

    def standing_in(name: str) -> Any:
        def declare(self: Any, *arguments: Any, **options: Any) -> Any:
            if threading.get_ident() == thread:
                names.append(name)
            return originals[name](self, *arguments, **options)

        return declare

    try:
        for name in DECLARATIONS:
            setattr(base, name, standing_in(name))
        yield names
    finally:
        for name, original in originals.items():
            setattr(base, name, original)


def is_pythons(block: Any) -> bool:
    """Whether a block's class, or one that it derives from, was written in Python."""
    return any(not base.__module__.startswith(("pydrake", "pybind11", "nanobind")) for base in type(block).__mro__[:-1])


def require_known_events(path: str, block: Any, declared: list[str]) -> None:
    """Refuse a block with events that a compiled run would leave out.

    Args:
        path: the block's.
        block: the block.
        declared: what :func:`recorded` wrote down while it was converted to symbols; nothing for a block of C++.

    Raises:
        LoweringError: it has such an event, or cannot be run by itself.
    """
    if left_out := [name for name in dict.fromkeys(declared) if name != CARRIED_OUT and name not in INERT]:
        raise LoweringError(path, f"it has events that a compiled run would leave out ({', '.join(left_out)})")
    timing = block.GetUniquePeriodicDiscreteUpdateAttribute()
    if CARRIED_OUT in declared and timing is None:
        raise LoweringError(path, "it has periodic updates at several periods or offsets")
    for k in range(block.num_input_ports()):
        port = block.get_input_port(k)
        if port.get_data_type() != PortDataType.kVectorValued and not is_pythons(block):
            raise LoweringError(path, f"its input port {port.get_name()!r} is abstract, so what it does is not known")
    ticks = Ticks(timing.offset_sec(), timing.period_sec()) if timing else None
    try:
        found = unexpected_event(block, ticks)
    except (Exception, SystemExit) as error:  # SystemExit is how Drake reports a failed demand
        raise LoweringError(path, f"which events it has cannot be found out by running it alone: {error}") from error
    if found:
        raise LoweringError(path, found)


def unexpected_event(block: Any, ticks: Ticks | None) -> str | None:
    """What a block does, run by itself, other than one periodic discrete update; None where it does nothing else.

    Args:
        block: a leaf system.
        ticks: when its periodic update is, if it has one.

    Raises:
        Exception: whatever the block raises where it cannot be run by itself.
    """
    with np.errstate(all="ignore"):
        return _unexpected_event(block, ticks)


def _unexpected_event(block: Any, ticks: Ticks | None) -> str | None:
    between = ticks.offset + BETWEEN * ticks.period if ticks else BETWEEN
    initialized, stepped = _moment(block, between)
    if any(initialized):
        return "it has an event when a Simulator is initialized, or publishes in every step"
    if any(stepped):
        return "it has an update in every step"
    if any(_at(block, begin, ticks) or any(_span(block, begin, end)) for begin, end in _windows(ticks)):
        return "it has an event of its own time that is not a periodic discrete update at one period and offset"
    return None


def _at(block: Any, time: float, ticks: Ticks | None) -> bool:
    """Whether something else than the periodic update happens at a time, to which Drake may be blind by rounding."""
    initialized, (publishes, updates, unrestricted) = _moment(block, time)
    known = int(ticks is not None and ticks.is_one(time))
    return any(initialized) or publishes > 0 or updates > known or unrestricted > 0


def _windows(ticks: Ticks | None) -> Iterator[tuple[float, float]]:
    """Spans of time between whose ends a block has no tick, from 0."""
    begin = 0.0
    for _ in range(WINDOWS):
        end = ticks.after(begin) if ticks else HORIZON
        yield begin, end
        if not ticks:
            return
        begin = end


def _alone(block: Any, time: float, step: float) -> Simulator:
    simulator = Simulator(block)
    ResetIntegratorFromFlags(simulator, "explicit_euler", step)  # it takes a step of any length, to wherever that leads
    context = simulator.get_mutable_context()
    context.SetTime(time)
    for k in range(block.num_input_ports()):
        port = block.get_input_port(k)
        if port.get_data_type() == PortDataType.kVectorValued:
            port.FixValue(context, INPUT + APART * (k + np.arange(port.size())))  # no two robots in one place
    return simulator


def _counts(simulator: Simulator) -> Counts:
    return (
        simulator.get_num_publishes(),
        simulator.get_num_discrete_updates(),
        simulator.get_num_unrestricted_updates(),
    )


def _moment(block: Any, time: float) -> tuple[Counts, Counts]:
    """What happens when a run begins at a time, and when its first step is about to be taken; no time goes by."""
    simulator = _alone(block, time, 1.0)
    simulator.Initialize()
    initialized = _counts(simulator)
    simulator.AdvancePendingEvents()
    return initialized, _counts(simulator)


def _span(block: Any, begin: float, end: float) -> Counts:
    """What happens first strictly between two times; where that is nothing, it takes one step."""
    margin = 1e-6 * (end - begin)
    simulator = _alone(block, begin + margin, end - begin)
    first = EventStatus.ReachedTermination(block, "something has happened")
    simulator.set_monitor(lambda _: first if any(_counts(simulator)) else EventStatus.DidNothing())
    simulator.AdvanceTo(end - margin)
    simulator.clear_monitor()
    return _counts(simulator)
