"""A real Dask cluster: a scheduler and two worker processes, one of which is killed."""

import json
import os
import signal
import socket
import subprocess
import sys
import time

import pytest
import xarray as xr
from sweep.quick import quick_sweep

from drake_formation.sweep import SweepError, SweepStoppedError, run_sweep
from drake_formation.sweep import cluster as module

SWEEP = quick_sweep(
    {"path": "springs.stiffness", "logspace": [1.0, 1e4, 20]},
    {"path": "consensus.delta", "linspace": [0.0, 1e3, 10]},
    scenario="quadrilateral",
)


def test_without_dask_it_is_said_how_to_get_it(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(SweepError, match=r"pip install 'drake-formation\[dask\]'"):
        run_sweep(SWEEP, tmp_path, scheduler="tcp://127.0.0.1:1")
    assert not list(tmp_path.iterdir())


@pytest.fixture
def patience(monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(module, "PATIENCE", 1.0)


def test_no_scheduler_is_said_so(tmp_path, patience):
    with pytest.raises(SweepError, match=r"no Dask scheduler at tcp://127\.0\.0\.1:1: .* after 1 s"):
        run_sweep(SWEEP, tmp_path, scheduler="tcp://127.0.0.1:1")


def test_something_else_that_listens_there_is_no_scheduler(tmp_path, patience):
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(SweepError, match=f"no Dask scheduler at {address} answered within 1 s"):
            run_sweep(SWEEP, tmp_path, scheduler=address)


@pytest.mark.parametrize(
    "address", ["foo://;x", "", "tcp://", "tcp://host", "tcp://host:x", "tcp://host:99999", "tcp://[", "inproc://a:1"]
)
def test_what_is_no_address_is_refused_at_once(tmp_path, address):
    pytest.importorskip("distributed")
    with pytest.raises(SweepError, match="give an address such as tcp://") as refused:
        run_sweep(SWEEP, tmp_path, scheduler=address)
    assert repr(address) in str(refused.value)
    assert not list(tmp_path.iterdir())


def dask(part, file, *options):
    command = [sys.executable, "-m", f"distributed.cli.dask_{part}", "--scheduler-file", str(file), *options]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


@pytest.fixture
def scheduler(tmp_path):
    pytest.importorskip("distributed")
    file = tmp_path / "scheduler.json"
    process = dask("scheduler", file, "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    try:
        while not file.exists():
            assert process.poll() is None
            time.sleep(0.05)
        yield process, file, json.loads(file.read_text())["address"]
    finally:
        process.kill()
        process.wait()


@pytest.fixture
def workers(scheduler):
    _, file, _ = scheduler
    options = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(file.parent))
    processes = [dask("worker", file, *options) for _ in range(2)]
    yield processes
    for process in processes:
        process.kill()
        process.wait()


def test_a_scheduler_without_workers_is_said_so(tmp_path, patience, scheduler):
    with pytest.raises(SweepError, match="has no workers"):
        run_sweep(SWEEP, tmp_path / "out", scheduler=scheduler[2])


@pytest.mark.slow
def test_a_cluster_that_loses_a_worker_gives_the_same_to_the_last_bit(tmp_path, scheduler, workers):
    killed = []

    def kill_one(tally):
        if tally.finished > 50 and not killed:
            killed.append(tally.finished)
            os.kill(workers[0].pid, signal.SIGKILL)

    with run_sweep(SWEEP, tmp_path / "cluster", scheduler=scheduler[2], figures=False, progress=kill_one) as dataset:
        found = dataset.load()
    assert killed
    assert killed[0] < found["status"].size
    assert workers[1].poll() is None
    with run_sweep(SWEEP, tmp_path / "serial", executor="serial", figures=False) as dataset:
        xr.testing.assert_identical(found, dataset.load())


@pytest.mark.slow
def test_a_lost_scheduler_stops_the_sweep_which_then_goes_on_elsewhere(tmp_path, scheduler, workers):
    from dask import config

    told = []

    def kill_scheduler(tally):
        told.append(tally)
        if tally.finished > 20:
            scheduler[0].kill()

    lost = pytest.raises(SweepStoppedError, match="connection to the Dask scheduler")
    with lost, config.set({"distributed.comm.timeouts.connect": "2s"}):
        run_sweep(SWEEP, tmp_path / "out", scheduler=scheduler[2], figures=False, progress=kill_scheduler)
    resumed = []
    run_sweep(SWEEP, tmp_path / "out", executor="serial", figures=False, progress=resumed.append).close()
    assert resumed[0].resumed == told[-1].finished
    assert resumed[-1].finished == 200
