"""Kill -9, Ctrl-C and SIGTERM: nothing that was finished is lost, and nobody is left behind.

Kills of a sweep's parent and workers at every moment are in ``tests/sweep/test_run.py`` and ``test_processes.py``,
those of a Dask worker and scheduler in ``tests/sweep/test_cluster.py``.
"""

import os
import signal
import time
from pathlib import Path

import pytest
from faults.conftest import RUN, ended, files, started, sweep_file
from watching import count, gone

pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc to find processes in")


def children(pid):
    """Process numbers of a process's children."""
    return [int(line) for file in Path(f"/proc/{pid}/task").glob("*/children") for line in file.read_text().split()]


def until(condition, process):
    while not condition():
        assert process.poll() is None
        time.sleep(0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "status", "word"), [(signal.SIGINT, 130, "interrupted"), (signal.SIGTERM, 143, "terminated")]
)
def test_a_sweep_that_is_asked_to_end_says_how_to_go_on(tmp_path, number, status, word):
    quick, out = sweep_file(tmp_path, 4000), tmp_path / "o"
    process = started("sweep", quick, "--out", out, "--workers", 2, cwd=tmp_path)
    until(lambda: count(out) > 20, process)
    workers = children(process.pid)
    process.send_signal(number)
    result = ended(process)
    assert result.status == status
    assert word in result.err
    assert f"Finished runs are kept in {out}; the same command goes on from there." in result.err
    assert workers
    assert all(map(gone, workers))
    assert count(out) > 20


def test_a_sweep_whose_parent_is_killed_leaves_silence_and_its_runs(tmp_path):
    quick, out = sweep_file(tmp_path, 4000), tmp_path / "o"
    process = started("sweep", quick, "--out", out, "--workers", 2, cwd=tmp_path)
    until(lambda: count(out) > 20, process)
    workers = children(process.pid)
    process.kill()
    result = ended(process)
    assert all(map(gone, workers))
    assert (result.status, result.out, result.err.strip()) == (-9, "", "")
    assert count(out) > 20


@pytest.mark.slow
def test_a_run_that_is_killed_leaves_its_place_free(tmp_path):
    long = [part.replace("=0.3", "=1000000") for part in RUN]
    process = started(*long, "--out", tmp_path / "o", cwd=tmp_path)
    until(lambda: any(tmp_path.iterdir()), process)
    process.kill()
    assert ended(process).status == -9
    result = ended(started(*RUN, "--out", tmp_path / "o", cwd=tmp_path))
    assert result.status == 0
    assert {"metrics.json", "result.nc", "scenario.yaml"} <= set(files(tmp_path / "o"))


@pytest.mark.slow
def test_a_study_goes_on_when_a_worker_is_killed_and_after_its_parent_is(tmp_path):
    out = tmp_path / "o"
    command = ("reproduce", "--only", "table2", "--out", out)

    def kept():
        return {path: path.stat().st_mtime_ns for path in (out / "runs").glob("*.json")}

    process = started(*command, cwd=tmp_path)
    until(lambda: len(kept()) > 0, process)
    os.kill(children(process.pid)[-1], signal.SIGKILL)
    until(lambda: len(kept()) > 2, process)
    workers = children(process.pid)
    process.kill()
    result = ended(process)
    assert workers
    assert all(map(gone, workers))
    assert (result.status, result.err.strip()) == (-9, "")
    before = kept()
    assert ended(started(*command, cwd=tmp_path)).status == 0
    assert before.items() <= kept().items()
    assert (out / "report.html").stat().st_size > 1000
