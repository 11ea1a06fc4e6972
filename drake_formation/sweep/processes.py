"""Worker processes on this machine, each with a pipe of its own, so that one that dies takes only its call along."""

import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar

import drake_formation
from drake_formation.sweep.errors import SweepStoppedError
from drake_formation.sweep.work import Chunk, Report, run_chunk

T = TypeVar("T")

BUILDS_PER_WORKER = 256
"""Drake 1.51 leaks the Python systems of every diagram that was built; a worker is replaced before that matters."""

ONE_THREAD = dict.fromkeys(
    ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS", "NUMBA_NUM_THREADS"], "1"
)
"""Environment in which the libraries of a worker keep to one thread: there is a worker for each processor."""


class WorkerDiedError(RuntimeError):
    """A worker process ended while it had something to do."""


class Processes:
    """Worker processes, started when they are first needed.

    A worker is an interpreter of its own (not a fork: the compiler and Drake have threads), told nothing of the
    caller's main module, so that scripts need no guard and notebooks no file. It ends when its pipe is closed, be it
    because this process was killed.

    Args:
        workers: how many.
    """

    blocking = False
    deaths: tuple[type[BaseException], ...] = (WorkerDiedError,)

    def __init__(self, workers: int) -> None:
        self.slots = workers
        self._threads = ThreadPoolExecutor(workers)
        self._access = threading.Lock()
        self._idle: list[_Worker] = []
        self._all: set[_Worker] = set()
        self._closed = False

    @property
    def pids(self) -> list[int]:
        """Process numbers of the workers."""
        with self._access:
            return [worker.pid for worker in self._all]

    def submit(self, chunk: Chunk) -> "Future[Report]":
        """Hand out a chunk."""
        return self.call(run_chunk, chunk)

    def call(self, function: Callable[..., T], *arguments: Any) -> "Future[T]":
        """Have a function carried out in a worker, which imports it by its name."""
        return self._threads.submit(self._run, function, arguments)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self._access:
            self._closed = True
            workers = list(self._all)
        for worker in workers:
            worker.kill()
        self._threads.shutdown(cancel_futures=True)

    def _run(self, function: Callable[..., T], arguments: tuple[Any, ...]) -> T:
        worker = self._take()
        try:
            answer: T = worker.run(function, arguments)
        except BaseException:
            self._remove(worker)
            raise
        if isinstance(answer, Report) and answer.built >= BUILDS_PER_WORKER:
            self._remove(worker)
        else:
            with self._access:
                self._idle.append(worker)
        return answer

    def _take(self) -> "_Worker":
        with self._access:
            if self._closed:
                raise WorkerDiedError("the workers are closed")
            if self._idle:
                return self._idle.pop()
            worker = _Worker()
            self._all.add(worker)
        return worker

    def _remove(self, worker: "_Worker") -> None:
        worker.kill()
        with self._access:
            self._all.discard(worker)


class _Worker:
    """A process that does one thing at a time.

    Raises:
        SweepStoppedError: the system lets no more processes start.
    """

    def __init__(self) -> None:
        package = str(Path(drake_formation.__file__).parents[1])
        path = os.pathsep.join(filter(None, [package, os.environ.get("PYTHONPATH")]))
        # A process group of its own: Ctrl-C is for this process, which ends the workers in good order.
        try:
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "drake_formation.sweep.worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env=os.environ | ONE_THREAD | {"PYTHONPATH": path},
                process_group=0,
            )
        except OSError as error:
            raise SweepStoppedError(f"a worker process cannot be started: {error.strerror}") from error
        self._ready = False

    @property
    def pid(self) -> int:
        return self._process.pid

    def run(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
        """Have a function carried out; gives what it gives and raises what it raises.

        Raises:
            WorkerDiedError: the process ended meanwhile.
            SweepStoppedError: it never began.
        """
        assert self._process.stdin
        assert self._process.stdout
        try:
            if not self._ready:
                self._ready = bool(pickle.load(self._process.stdout))
            pickle.dump((function, arguments), self._process.stdin)
            self._process.stdin.flush()
            answer = pickle.load(self._process.stdout)
        except (EOFError, BrokenPipeError, pickle.UnpicklingError) as error:
            status = self._process.wait()
            if not self._ready and status > 0:
                message = f"a worker process did not start (exit status {status}); its messages are above"
                raise SweepStoppedError(message) from error
            raise WorkerDiedError(_cause(status)) from error
        if isinstance(answer, BaseException):
            raise answer
        return answer

    def kill(self) -> None:
        """End the process now; it has nothing to lose."""
        self._process.kill()
        self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            try:
                if pipe:
                    pipe.close()
            except OSError:  # what was still to be written has no reader any more
                pass


def _cause(status: int) -> str:
    """What a process's exit status says."""
    if status >= 0:
        return f"the worker process ended with exit status {status}"
    hint = "; the system does that when memory runs out" if status == -9 else ""
    return f"the worker process was killed by signal {-status}{hint}"
