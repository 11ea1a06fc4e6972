"""Handing out a sweep's points in chunks, and taking back what comes of them."""

from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from drake_formation.sweep.definition import Sweep
from drake_formation.sweep.executors import Executor
from drake_formation.sweep.work import Chunk, Outcome, Report, Task

CHUNK_TIME = 1.0
"""How long a chunk should take (s): long beside what it costs to send, short beside what a kill may cost."""
SHORTEST_TIME = 0.02
"""Below this (s) it costs more to send a chunk than even shares among the workers save."""
MOST_POINTS = 256
"""Of a chunk."""


def drive(
    sweep: Sweep,
    task: Task,
    points: NDArray[np.int_],
    executor: Executor,
    keep: Callable[[Sequence[Outcome]], None],
) -> None:
    """Run points of a sweep.

    A chunk whose worker dies is run again point by point; a point over which a worker dies once more has failed.

    Args:
        sweep: the sweep.
        task: what its runs have in common.
        points: numbers of the points to run.
        executor: who runs them.
        keep: called with outcomes as they come, in any order.
    """
    supply = _Supply(sweep, task, points)
    waiting: dict[Future[Report], Chunk] = {}
    outcomes: list[Outcome] = []
    while True:
        if outcomes and executor.blocking:
            keep(outcomes)
            outcomes = []
        slots = executor.slots
        while len(waiting) < slots and (chunk := supply.take(slots)):
            waiting[executor.submit(chunk)] = chunk
        if outcomes:  # while they are written, the workers are busy again
            keep(outcomes)
            outcomes = []
        if not waiting:
            return
        for future in wait(waiting, return_when=FIRST_COMPLETED).done:
            chunk = waiting.pop(future)
            try:
                report = future.result()
            except executor.deaths as death:
                if chunk.retried:
                    outcomes += [Outcome(index, str(death)) for index, _ in chunk.points]
                else:
                    supply.give_back(chunk)
                continue
            supply.learn(report)
            outcomes += report.outcomes


class _Supply:
    """Chunks of the points that are left, of about the right duration."""

    def __init__(self, sweep: Sweep, task: Task, points: NDArray[np.int_]) -> None:
        self._sweep, self._task, self._points = sweep, task, points
        self._next = 0
        self._again: deque[Chunk] = deque()
        self._seconds_per_point = CHUNK_TIME

    def take(self, slots: int) -> Chunk | None:
        """The next chunk; smaller ones towards the end, so that all workers end together."""
        if self._again:
            return self._again.popleft()
        left = len(self._points) - self._next
        if not left:
            return None
        most, least = (int(seconds / self._seconds_per_point) for seconds in (CHUNK_TIME, SHORTEST_TIME))
        share = left if slots == 1 else left // (2 * slots)
        size = max(1, min(most, MOST_POINTS, left, max(share, least)))
        indices = self._points[self._next : self._next + size].tolist()
        self._next += size
        return Chunk(self._task, tuple((index, self._sweep.overrides(index)) for index in indices))

    def give_back(self, chunk: Chunk) -> None:
        """Take back a chunk whose worker died, to be run again point by point."""
        self._again.extend(replace(chunk, points=(point,), retried=True) for point in chunk.points)

    def learn(self, report: Report) -> None:
        """Take a chunk's duration into account."""
        self._seconds_per_point = max(report.seconds / max(len(report.outcomes), 1), 1e-6)
