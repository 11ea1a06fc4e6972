"""Drake's logs in a compiled run: they record when Drake's Simulator would let them.

A log without a period records in every step; the steps of a compiled run are its own.
"""

from itertools import pairwise
from typing import Any

from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import Context
from pydrake.systems.primitives import VectorLogSink

from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.ticks import Ticks

SHORTEST, LONGEST = 1e-6, 1e6
"""Periods (s) of logs; one that is longer records at the start alone."""


class Logs:
    """The logs of a diagram.

    Args:
        blocks: all blocks of the diagram by path.

    Raises:
        LoweringError: a log cannot be told to record.
    """

    def __init__(self, blocks: dict[str, Any]) -> None:
        self.every_step: list[Any] = []
        self._periodic: list[tuple[Any, Ticks]] = []
        for path, block in blocks.items():
            if isinstance(block, VectorLogSink):
                period = _period(path, block)
                if period == 0:
                    self.every_step.append(block)
                elif period is not None:
                    self._periodic.append((block, Ticks(0.0, period)))

    def __bool__(self) -> bool:
        return bool(self.every_step or self._periodic)

    def after(self, time: float, end: float) -> float:
        """The next time after this one at which a log records by its period, at most the end."""
        return min([end, *(ticks.after(time) for _, ticks in self._periodic)])

    def record_step(self, context: Context) -> None:
        """Let the logs of every step record the Context."""
        for log in self.every_step:
            _record(log, context)

    def record_due(self, context: Context) -> None:
        """Let the logs whose time has come record the Context."""
        for log, ticks in self._periodic:
            if ticks.is_one(context.get_time()):
                _record(log, context)


def _record(log: Any, root: Context) -> None:
    """Record, unless the log has done so at that time."""
    context = log.GetMyContextFromRoot(root)
    times = log.GetLog(context).sample_times()
    if not len(times) or times[-1] != root.get_time():
        log.ForcedPublish(context)


def _period(path: str, log: Any) -> float | None:
    """How far apart a log's records are (s), read off a run of its own; 0: every step; None: it never records.

    Raises:
        LoweringError: it records, but not when told to.
    """
    simulator = Simulator(log)
    context = simulator.get_mutable_context()
    log.get_input_port().FixValue(context, [0.0] * log.get_input_port().size())
    simulator.Initialize()
    for end in (0.25 * SHORTEST, 0.5 * SHORTEST):
        simulator.AdvanceTo(end)
    count = len(log.GetLog(context).sample_times())
    log.ForcedPublish(context)
    if count and len(log.GetLog(context).sample_times()) == count:
        raise LoweringError(path, "it is a log that cannot be told to record; give it Drake's default triggers")
    if count == 0:
        return None
    if count > 1:
        return 0.0
    return _first_gap(log)


def _first_gap(log: Any) -> float | None:
    end = 4 * SHORTEST
    while end < LONGEST:
        simulator = Simulator(log)
        context = simulator.get_mutable_context()
        log.get_input_port().FixValue(context, [0.0] * log.get_input_port().size())
        ResetIntegratorFromFlags(simulator, "explicit_euler", end)
        simulator.AdvanceTo(end)
        times = log.GetLog(context).sample_times()
        if len(times) > 1:
            return float(next(later - earlier for earlier, later in pairwise(times)))
        end *= 4
    return None
