"""Which events a block has, found out without asking its code by name.

Drake reports to Python a block's one periodic discrete update and its witness functions, and nothing else. The rest is
found out as follows.

- A block of Python's that converts to symbols runs its constructor again for that. Whatever declares an event then, the
  block's own code, a helper or a factory, calls Drake's ``LeafSystem``, where it is written down.
- A block of C++ is run by itself in a Simulator for two short steps between its ticks; Drake counts what happens.
- Of any other block nothing is known, and it is refused.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from pydrake.symbolic import Expression
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import LeafSystem_, PortDataType

from drake_formation.lowering.errors import LoweringError

CARRIED_OUT = "DeclarePeriodicDiscreteUpdateEvent"
"""What a compiled run does as Drake does, given that the block has one period and offset."""

INERT = {"DeclareForcedDiscreteUpdateEvent", "DeclareForcedPublishEvent", "DeclareForcedUnrestrictedUpdateEvent"}
"""What a Simulator never does by itself."""

DECLARATIONS = tuple(
    name for name in dir(LeafSystem_[Expression]) if name.startswith("Declare") and name.endswith("Event")
)
"""All of Drake's ways to declare an event."""

MOMENT = 1e-6
"""Length of a step in which a block of C++ shows what it does in every step (s)."""


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


def require_known_events(path: str, block: Any, symbolic: Any, declared: list[str]) -> None:
    """Refuse a block of Python's with events that a compiled run would leave out.

    Args:
        path: the block's.
        block: the block.
        symbolic: the same, converted to symbols.
        declared: what :func:`recorded` wrote down during that.

    Raises:
        LoweringError: it has such an event.
    """
    if left_out := [name for name in dict.fromkeys(declared) if name != CARRIED_OUT and name not in INERT]:
        raise LoweringError(path, f"it has events that a compiled run would leave out ({', '.join(left_out)})")
    if CARRIED_OUT in declared and block.GetUniquePeriodicDiscreteUpdateAttribute() is None:
        raise LoweringError(path, "it has periodic updates at several periods or offsets")
    if _timing(block) != _timing(symbolic):
        raise LoweringError(path, "its updates in double are not those that it has in symbols")


def require_quiet(path: str, block: Any) -> None:
    """Refuse a block of C++ with events that a compiled run would leave out.

    Raises:
        LoweringError: it has such an event, or cannot be run by itself.
    """
    try:
        counts = list(_counts(path, block))
    except (RuntimeError, SystemExit) as error:  # SystemExit is how Drake reports a failed demand
        raise LoweringError(path, f"which events it has cannot be found out by running it alone: {error}") from error
    started, once, twice = counts
    if any(started):
        raise LoweringError(path, "it has an event when a Simulator is initialized")
    if once != twice:
        raise LoweringError(path, "it has an event in every step")
    if any(twice):
        raise LoweringError(path, "it has an event of its own time")


def _counts(path: str, block: Any) -> Iterator[tuple[int, int, int]]:
    """Publishes, discrete and unrestricted updates when a run begins between two ticks, and after one and two steps."""
    simulator = Simulator(block)
    context = simulator.get_mutable_context()
    for k in range(block.num_input_ports()):
        port = block.get_input_port(k)
        if port.get_data_type() != PortDataType.kVectorValued:
            raise LoweringError(path, f"its input port {port.get_name()!r} is abstract, so what it does is not known")
        port.FixValue(context, [0.0] * port.size())
    timing = block.GetUniquePeriodicDiscreteUpdateAttribute()
    begin, step = (timing.offset_sec() + 0.25 * timing.period_sec(), timing.period_sec()) if timing else (0.25, 1.0)
    step *= MOMENT
    context.SetTime(begin)
    ResetIntegratorFromFlags(simulator, "explicit_euler", step)
    simulator.Initialize()
    for end in (begin, begin + step, begin + 2 * step):
        simulator.AdvanceTo(end)
        yield (
            simulator.get_num_publishes(),
            simulator.get_num_discrete_updates(),
            simulator.get_num_unrestricted_updates(),
        )


def _timing(block: Any) -> tuple[float, float] | None:
    timing = block.GetUniquePeriodicDiscreteUpdateAttribute()
    return (timing.period_sec(), timing.offset_sec()) if timing else None
