"""Handing out a sweep's points in chunks, and taking back what comes of them."""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from drake_formation.sweep.definition import Sweep
from drake_formation.sweep.executors import Executor
from drake_formation.sweep.work import Chunk, Outcome, Report, Task

CHUNK_TIME = 1.0
"""How long a chunk should take (s): long beside what it costs to send, short beside what a kill may cost."""
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
    again: deque[Chunk] = deque()
    pace = _Pace(len(points))
    fresh = _chunks(sweep, task, points, lambda: pace.size(executor.slots))
    waiting: dict[Future[Report], Chunk] = {}
    while True:
        while len(waiting) < executor.slots:
            chunk = again.popleft() if again else next(fresh, None)
            if chunk is None:
                break
            waiting[executor.submit(chunk)] = chunk
        if not waiting:
            return
        for future in wait(waiting, return_when=FIRST_COMPLETED).done:
            chunk = waiting.pop(future)
            try:
                report = future.result()
            except executor.deaths as death:
                if chunk.retried:
                    keep([Outcome(index, str(death)) for index, _ in chunk.points])
                else:
                    again.extend(replace(chunk, points=(point,), retried=True) for point in chunk.points)
                continue
            pace.learn(report, len(chunk.points))
            keep(report.outcomes)


def _chunks(sweep: Sweep, task: Task, points: NDArray[np.int_], size: Callable[[], int]) -> Iterator[Chunk]:
    first = 0
    while first < len(points):
        last = first + size()
        yield Chunk(task, tuple((int(index), sweep.overrides(int(index))) for index in points[first:last]))
        first = last


class _Pace:
    """How many points make a chunk of about the right duration."""

    def __init__(self, points: int) -> None:
        self._left = points
        self._seconds_per_point = CHUNK_TIME

    def learn(self, report: Report, points: int) -> None:
        """Take a chunk's duration into account."""
        self._left -= points
        self._seconds_per_point = max(report.seconds / points, 1e-6)

    def size(self, slots: int) -> int:
        """Points of the next chunk; fewer towards the end, so that all workers end together."""
        wanted = int(CHUNK_TIME / self._seconds_per_point)
        return max(1, min(wanted, MOST_POINTS, self._left // (2 * slots)))
