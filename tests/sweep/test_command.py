"""``drake-formation sweep``: what it says, its exit status, and that it can be stopped."""

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr

QUICK = """\
name: mine
scenario: line
set: {aggregation.duration: 0.5, transport.duration: 0.5, robots.start: {centre: [2.5, 3.5]}}
axes:
  - path: springs.stiffness
    logspace: [1.0, 1.0e+4, 4]
  - path: robots.mass
    values: [40.0, [30.0, 50.0]]
"""
FAILING = QUICK.replace("[30.0, 50.0]", "[30.0, 40.0, 50.0]")
LONG = QUICK.replace("transport.duration: 0.5", "transport.duration: 60.0").replace("1.0e+4, 4", "1.0e+4, 4000")


def test_a_sweep_writes_its_dataset_and_figures_and_says_where(cli):
    Path("mine.yaml").write_text(QUICK)
    status, out, _ = cli("sweep", "mine.yaml", "--out", "o", "--executor", "serial")
    assert status == 0
    assert "8 runs in o/sweep.nc, pictures in o/figures." in out
    assert "peak control force" in out
    with xr.open_dataset("o/sweep.nc") as dataset:
        assert dataset.attrs["sweep"] == QUICK
        assert list(dataset["mass"].values) == ["40.0", "[30.0, 50.0]"]
    assert Path("o/figures/peak_force_n.png").stat().st_size > 1000


def test_failed_runs_end_in_status_3_and_say_where_their_errors_are(cli):
    Path("mine.yaml").write_text(FAILING)
    for retry in ([], ["--retry-failed"]):
        status, out, _ = cli("sweep", "mine.yaml", "--out", "o", "--executor", "serial", *retry)
        assert status == 3
        assert "4 runs in o/sweep.nc" in out
        assert "4 runs failed: why is in o/failures.csv. --retry-failed runs them again." in out
    assert len(Path("o/failures.csv").read_text().splitlines()) == 5


def test_what_is_wrong_is_said_before_anything_runs(cli):
    Path("mine.yaml").write_text(QUICK.replace("springs.stiffness", "springs.stifness"))
    status, _, err = cli("sweep", "mine.yaml", "--out", "o")
    assert status == 2
    assert "mine.yaml:6: springs.stifness: unknown key" in err
    assert "did you mean 'stiffness'?" in err
    assert not Path("o").exists()
    assert cli("sweep", "ganis", "--out", "o")[0] == 2


def test_another_sweep_in_the_folder_is_refused(cli):
    Path("mine.yaml").write_text(QUICK)
    assert cli("sweep", "mine.yaml", "--out", "o", "--executor", "serial")[0] == 0
    status, _, err = cli("sweep", "mine.yaml", "--out", "o", "--engine", "blocks")
    assert status == 2
    assert "engine compiled, now blocks" in err


@pytest.mark.slow
def test_ctrl_c_stops_in_good_order_and_says_how_to_go_on(tmp_path):
    (tmp_path / "long.yaml").write_text(LONG)
    command = [sys.executable, "-m", "drake_formation", "sweep", "long.yaml", "--out", "o", "--workers", "1"]
    output = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, cwd=tmp_path, text=True, **output) as process:
        journal = tmp_path / "o" / "runs.sqlite"
        while not journal.exists() or journal.stat().st_size < 40_000:
            assert process.poll() is None
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "interrupted" in err
    assert "Finished runs are kept in o; the same command goes on from there." in err
    assert "Traceback" not in err
