"""Real worker processes: killed, crashed, recycled, orphaned."""

import os
import pickle
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
from watching import gone

from drake_formation.sweep import processes as module
from drake_formation.sweep.errors import SweepError, SweepStoppedError
from drake_formation.sweep.processes import Processes, WorkerDiedError
from drake_formation.sweep.work import Chunk, Task, versions


@pytest.fixture
def task(sweep):
    return Task(sweep.base.data, "compiled", None, versions())


@pytest.fixture
def chunk(sweep, task):
    return lambda *indices: Chunk(task, tuple((index, sweep.overrides(index)) for index in indices))


class Deadly:
    """Kills the process that unpickles it."""

    def __reduce__(self):
        return os._exit, (7,)


def test_a_workers_death_is_its_chunks_alone_and_the_next_has_a_new_worker(chunk, task):
    with Processes(1) as workers:
        assert workers.submit(chunk(0)).result().outcomes[0].error is None
        (first,) = workers.pids
        with pytest.raises(WorkerDiedError, match="exit status 7"):
            workers.submit(Chunk(task, ((0, {"springs.stiffness": Deadly()}),))).result()
        assert workers.submit(chunk(1)).result().outcomes[0].error is None
        (second,) = workers.pids
    assert first != second
    assert gone(first, seconds=10)
    assert gone(second, seconds=10)


def test_a_killed_worker_says_so(chunk):
    with Processes(1) as workers:
        workers.submit(chunk(0)).result()
        os.kill(workers.pids[0], signal.SIGKILL)
        with pytest.raises(WorkerDiedError, match=r"signal 9; the system does that when memory runs out"):
            workers.submit(chunk(1)).result()


def test_a_worker_is_replaced_after_so_many_diagrams(chunk, monkeypatch):
    monkeypatch.setattr(module, "BUILDS_PER_WORKER", 1)
    with Processes(1) as workers:
        workers.submit(chunk(0)).result()
        assert not workers.pids


def test_what_a_chunk_raises_comes_back(sweep):
    task = Task(sweep.base.data, "compiled", None, versions() | {"numpy": "0.0"})
    with Processes(1) as workers, pytest.raises(SweepError, match="numpy"):
        workers.submit(Chunk(task, ())).result()


@pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="no /proc to look into")
def test_workers_keep_to_one_thread(chunk):
    with Processes(1) as workers:
        workers.submit(chunk()).result()
        environment = Path(f"/proc/{workers.pids[0]}/environ").read_bytes().split(b"\0")
    assert {b"OMP_NUM_THREADS=1", b"OPENBLAS_NUM_THREADS=1", b"NUMBA_NUM_THREADS=1"} <= set(environment)


def test_any_function_is_carried_out(chunk):
    with Processes(1) as workers:
        assert workers.call(divmod, 17, 5).result() == (3, 2)
        with pytest.raises(ZeroDivisionError):
            workers.call(divmod, 17, 0).result()


def test_an_answer_that_cannot_be_sent_is_an_error_and_no_death():
    with Processes(1) as workers:
        with pytest.raises(RuntimeError, match="the answer cannot be sent"):
            workers.call(threading.Lock).result()
        assert workers.call(divmod, 17, 5).result() == (3, 2)


def test_a_system_that_lets_no_process_start_stops_the_sweep(chunk, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with Processes(1) as workers, pytest.raises(SweepStoppedError, match="cannot be started: No such file"):
        workers.submit(chunk(0)).result()


def test_an_interpreter_that_cannot_start_stops_the_sweep(chunk, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with Processes(1) as workers, pytest.raises(SweepStoppedError, match="did not start"):
        workers.submit(chunk(0)).result()


PARENT = """
import sys
from drake_formation.sweep import load_sweep
from drake_formation.sweep.processes import Processes
from drake_formation.sweep.work import Chunk, Task, versions
sweep = load_sweep("gains")
task = Task(sweep.base.data, "compiled", None, versions())
points = tuple((index, sweep.overrides(index)) for index in range({points}))
with Processes(2) as workers:
    for _ in range(2):
        workers.submit(Chunk(task, ())).result()
    if {waiting}:
        waiting = [workers.submit(Chunk(task, points * 100)) for _ in range(2)]
    print(*workers.pids, flush=True)
    sys.stdin.read()
"""


@pytest.mark.parametrize(("points", "waiting"), [(0, False), (64, True), (0, True)])
def test_workers_end_in_silence_when_their_parent_is_killed(points, waiting):
    """Idle, at work, and about to answer."""
    code = PARENT.format(points=points, waiting=waiting)
    streams = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", code], text=True, **streams) as parent:
        workers = list(map(int, parent.stdout.readline().split()))
        parent.kill()
        parent.wait()
        assert workers
        assert all(gone(pid, seconds=10) for pid in workers)
        assert parent.stderr.read() == ""


def test_a_worker_whose_answer_has_no_reader_ends_in_silence():
    command = [sys.executable, "-m", "drake_formation.sweep.worker"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as worker:
        assert pickle.load(worker.stdout) is True
        worker.stdout.close()
        pickle.dump((divmod, (17, 5)), worker.stdin)
        worker.stdin.flush()
        assert worker.wait(timeout=60) == 0
        assert worker.stderr.read() == b""
