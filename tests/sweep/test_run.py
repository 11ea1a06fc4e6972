"""A whole sweep: the same dataset to the last bit whoever runs it, in whatever order, however often it is killed."""

import csv
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
import xarray as xr
from sweep.quick import FAILING, QUICK, quick_sweep
from watching import count

from drake_formation import metrics, simulate
from drake_formation.sweep import SweepError, SweepStoppedError, load_sweep, run_sweep
from drake_formation.sweep import run as module
from drake_formation.sweep.processes import Processes
from drake_formation.sweep.work import CODE, versions

SERIES = {"variables": ["position", "control_force"], "every": 0.25}
LARGER = quick_sweep(
    {"path": "springs.stiffness", "logspace": [1.0, 1e4, 10]},
    {"kind": "list", "points": [{"label": "ring", "set": {"consensus.graph": "cycle"}}, {"label": "all", "set": {}}]},
    {"kind": "random", "seed": 3, "count": 6, "draw": {"robots.mass": {"uniform": [30.0, 50.0]}}},
    scenario="quadrilateral",
    trajectories=SERIES,
)
"""120 points of two structures."""


def run(sweep, out, **settings):
    """The dataset of a sweep in memory."""
    with run_sweep(sweep, out, **({"executor": "serial", "figures": False} | settings)) as dataset:
        return dataset.load()


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """The larger sweep, run in this process."""
    return run(LARGER, tmp_path_factory.mktemp("serial"))


def test_every_run_is_the_simulation_of_its_scenario(tmp_path, sweep):
    dataset = run(sweep, tmp_path)
    assert dataset["status"].dims == ("stiffness", "delta")
    assert (dataset["status"] == 1).all()
    for index in range(len(sweep)):
        wanted = metrics(simulate(sweep.scenario(index), engine="compiled")).to_dict()
        k, d = sweep.positions(index)
        found = dataset.isel(stiffness=k, delta=d)
        for name, value in wanted.items():
            np.testing.assert_array_equal(found[name], np.nan if value is None else value)
        assert float(found["stiffness"]) == sweep.overrides(index)["springs.stiffness"]


@pytest.mark.slow
def test_processes_give_the_same_to_the_last_bit(tmp_path, serial):
    xr.testing.assert_identical(run(LARGER, tmp_path, executor="processes", workers=2), serial)


def test_any_order_gives_the_same_to_the_last_bit(tmp_path, serial, monkeypatch):
    drive = module.drive

    def shuffled(sweep, task, points, executor, keep):
        drive(sweep, task, np.random.default_rng(1).permutation(points), executor, keep)

    monkeypatch.setattr(module, "drive", shuffled)
    xr.testing.assert_identical(run(LARGER, tmp_path), serial)


@pytest.mark.slow
def test_a_worker_killed_half_way_makes_no_difference(tmp_path, serial, monkeypatch):
    pools = []

    class Watched(Processes):
        def __init__(self, workers):
            super().__init__(workers)
            pools.append(self)

    monkeypatch.setattr("drake_formation.sweep.processes.Processes", Watched)
    killed = []

    def kill_one(tally):
        if tally.finished > 60 and not killed:
            killed.append(pools[0].pids[0])
            os.kill(killed[0], signal.SIGKILL)

    found = run(LARGER, tmp_path, executor="processes", workers=2, progress=kill_one)
    assert killed
    xr.testing.assert_identical(found, serial)


COMMAND = """
import json, sys
from drake_formation.sweep import run_sweep
run_sweep(json.loads(sys.argv[1]), sys.argv[2], executor=sys.argv[3], workers=2, figures=False)
"""


def start(sweep, folder, executor):
    return subprocess.Popen([sys.executable, "-c", COMMAND, json.dumps(sweep), str(folder), executor])


@pytest.mark.slow
@pytest.mark.parametrize(("executor", "moments"), [("serial", [0, 1, 1]), ("processes", [1, 1])])
def test_killed_again_and_again_it_goes_on_and_loses_nothing(tmp_path, serial, executor, moments):
    runs = []
    for moment in moments:
        process = start(LARGER, tmp_path, executor)
        while count(tmp_path) < moment and process.poll() is None:
            time.sleep(0.01)
        process.kill()
        process.wait()
        runs.append(count(tmp_path))
    assert runs == sorted(runs)
    assert 1 <= runs[-1] < 120
    tallies = []
    dataset = run(LARGER, tmp_path, progress=tallies.append)
    assert tallies[0].resumed == tallies[0].finished == runs[-1]
    assert tallies[-1].finished == len(load_sweep(LARGER))
    xr.testing.assert_identical(dataset, serial)


def test_what_is_finished_is_not_run_again(tmp_path, sweep, monkeypatch):
    first = run(sweep, tmp_path)

    def never(*_):
        raise AssertionError("run again")

    monkeypatch.setattr(module, "drive", never)
    xr.testing.assert_identical(run(sweep, tmp_path), first)


def test_failed_runs_are_kept_with_their_errors_and_the_rest_goes_on(tmp_path):
    dataset = run(quick_sweep(FAILING), tmp_path)
    assert dataset["status"].values.tolist() == [1, 2, 1, 2]
    assert dataset["peak_force_n"].isnull().values.tolist() == [False, True, False, True]
    errors = dataset["error"].values.tolist()
    assert errors[0] == errors[2] == ""
    assert "robots.mass" in errors[1]
    assert "the run stopped" in errors[3]
    with (tmp_path / "failures.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["point"]) for row in rows] == [1, 3]
    assert json.loads(rows[0]["sets"]) == {"robots.mass": [40.0, 40.0, 40.0]}
    assert [row["error"] for row in rows] == [errors[1], errors[3]]


def test_failed_runs_are_run_again_only_when_asked(tmp_path, monkeypatch):
    sweep = quick_sweep(FAILING)
    first = run(sweep, tmp_path)
    asked = []
    drive = module.drive

    def watched(sweep, task, points, executor, keep):
        asked.append(points.tolist())
        drive(sweep, task, points, executor, keep)

    monkeypatch.setattr(module, "drive", watched)
    run(sweep, tmp_path)
    assert asked == []
    tallies = []
    again = run(sweep, tmp_path, retry_failed=True, progress=tallies.append)
    assert asked == [[1, 3]]
    assert (tallies[0].finished, tallies[0].failed) == (2, 0)
    assert (tallies[-1].finished, tallies[-1].failed) == (4, 2)
    xr.testing.assert_identical(again, first)


def test_a_retry_that_is_killed_keeps_the_failures(tmp_path, monkeypatch):
    sweep = quick_sweep(FAILING)
    first = run(sweep, tmp_path)

    def interrupted(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(module, "drive", interrupted)
        with pytest.raises(KeyboardInterrupt):
            run(sweep, tmp_path, retry_failed=True)
    xr.testing.assert_identical(run(sweep, tmp_path), first)


def test_progress_is_told_when_runs_are_on_disk(tmp_path, sweep):
    on_disk = []
    run(sweep, tmp_path, progress=lambda tally: on_disk.append((tally.finished, count(tmp_path))))
    assert on_disk[0] == (0, 0)
    assert on_disk[-1] == (12, 12)
    assert all(told == kept for told, kept in on_disk)


def test_another_sweep_in_the_same_folder_is_refused(tmp_path, sweep):
    first = run(sweep, tmp_path)
    with pytest.raises(SweepError, match="another sweep"):
        run(quick_sweep(set=QUICK | {"robots.mass": 41.0}), tmp_path)
    with pytest.raises(SweepError, match="engine compiled, now blocks"):
        run(sweep, tmp_path, engine="blocks")
    with pytest.raises(SweepError, match="no engine"):
        run(sweep, tmp_path, engine="warp")
    xr.testing.assert_identical(run(sweep, tmp_path), first)


def test_the_engines_agree(tmp_path, sweep):
    compiled, blocks = run(sweep, tmp_path / "c"), run(sweep, tmp_path / "b", engine="blocks")
    for name in ("tracking_error_m", "consensus_error_m", "peak_force_n"):
        np.testing.assert_allclose(compiled[name], blocks[name], rtol=1e-5, atol=1e-6)
    assert (compiled.attrs["engine"], blocks.attrs["engine"]) == ("compiled", "blocks")


def test_open_workers_serve_several_sweeps(tmp_path, sweep):
    first = run(sweep, tmp_path / "a")
    with Processes(1) as workers:
        xr.testing.assert_identical(run(sweep, tmp_path / "b", executor=workers), first)
        pids = workers.pids
        xr.testing.assert_identical(run(sweep, tmp_path / "c", executor=workers), first)
        assert workers.pids == pids


def test_runs_of_other_code_are_never_mixed(tmp_path, sweep, monkeypatch):
    first = run(sweep, tmp_path)
    assert first.attrs["drake_formation_code"] == versions()[CODE]
    changed = versions() | {CODE: "0123456789abcdef"}
    with monkeypatch.context() as patch:
        patch.setattr(module, "versions", lambda: changed)
        with pytest.raises(SweepError, match=f"{CODE} {versions()[CODE]}, now 0123456789abcdef.*give another folder"):
            run(sweep, tmp_path)
    xr.testing.assert_identical(run(sweep, tmp_path), first)


def test_a_dataset_that_cannot_be_written_loses_no_run(tmp_path, sweep, monkeypatch):
    (tmp_path / "o" / "sweep.nc").mkdir(parents=True)
    (tmp_path / "o" / "runs.lock").touch()
    with pytest.raises(SweepStoppedError, match=r"sweep\.nc: cannot be written: Is a directory"):
        run(sweep, tmp_path / "o")
    assert not list((tmp_path / "o").glob(".*partial"))
    (tmp_path / "o" / "sweep.nc").rmdir()
    tallies = []
    found = run(sweep, tmp_path / "o", progress=tallies.append)
    assert tallies[0].resumed == len(sweep)
    xr.testing.assert_identical(found, run(sweep, tmp_path / "fresh"))
