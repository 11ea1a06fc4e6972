"""Who runs the chunks: this process, processes on this machine, or a cluster."""

import os
from collections.abc import Callable
from concurrent.futures import Future
from types import TracebackType
from typing import Protocol, Self

from drake_formation.sweep.errors import SweepError
from drake_formation.sweep.work import Chunk, Report, run_chunk

MOST_WORKERS = 1024
"""Processes on one machine, each an interpreter of some hundred megabytes."""


class Executor(Protocol):
    """Runs chunks; a context manager, whose end ends its workers."""

    @property
    def slots(self) -> int:
        """How many chunks to hand out at once."""

    @property
    def blocking(self) -> bool:
        """Whether handing out a chunk takes until it is done."""

    @property
    def deaths(self) -> tuple[type[BaseException], ...]:
        """What a future raises whose worker died."""

    def submit(self, chunk: Chunk) -> "Future[Report]":
        """Hand out a chunk."""

    def __enter__(self) -> Self:
        """Get ready."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """End the workers, also those at work."""


class Serial:
    """This very process."""

    slots = 1
    blocking = True
    deaths: tuple[type[BaseException], ...] = ()

    def submit(self, chunk: Chunk) -> "Future[Report]":
        """Run a chunk now."""
        future: Future[Report] = Future()
        try:
            future.set_result(run_chunk(chunk))
        except Exception as error:
            future.set_exception(error)
        return future

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        pass


def choose(name: str, workers: int | None, scheduler: str | None) -> Executor:
    """The executor of a name.

    Args:
        name: ``serial`` or ``processes``; of no account where there is a scheduler.
        workers: number of processes; as many as processors if None.
        scheduler: address of a Dask scheduler.

    Raises:
        SweepError: there is none of this name, or no cluster to be had.
    """
    if scheduler is not None:
        from drake_formation.sweep.cluster import Cluster

        return Cluster(scheduler)
    makers: dict[str, Callable[[], Executor]] = {"serial": Serial, "processes": lambda: _processes(workers)}
    if name not in makers:
        raise SweepError(f"no executor {name!r}; there are {', '.join(makers)}")
    return makers[name]()


def _processes(workers: int | None) -> Executor:
    from drake_formation.sweep.processes import Processes

    if workers is not None and not 1 <= workers <= MOST_WORKERS:
        raise SweepError(f"{workers} workers; give at least one and at most {MOST_WORKERS}")
    return Processes(workers or processors())


def processors() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
