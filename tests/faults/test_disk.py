"""A full disk and a read-only one, for every command that writes."""

import re
import resource
import shutil
import sys
from pathlib import Path

import pytest
import xarray as xr
from faults.conftest import RUN, ended, files, started, sweep_file

from drake_formation.measuring import metrics

REPRODUCE = ("reproduce", "--only", "table1")
ANALYZE = ("analyze", "line")
COMMANDS = [RUN, REPRODUCE, pytest.param(ANALYZE, marks=pytest.mark.slow)]


def named(command):
    return command[0]


@pytest.mark.parametrize("command", [RUN, REPRODUCE, ANALYZE], ids=named)
def test_a_read_only_disk_is_said_so_before_anything_is_run(cli, disk, command):
    disk.mount("ro")
    status, out, err = cli(*command, "--out", disk.folder / "o")
    assert (status, out) == (2, "")
    assert "Read-only file system" in err
    assert str(disk.folder / "o") in err


def test_a_sweep_onto_a_read_only_disk_is_refused(cli, disk, quick):
    disk.mount("ro")
    status, _, err = cli("sweep", quick, "--out", disk.folder / "o", "--executor", "serial")
    assert status == 2
    assert "Read-only file system" in err


def test_a_finished_sweep_on_a_disk_that_became_read_only_is_left_as_it_is(cli, disk, tmp_path):
    disk.mount("size=20m")
    command = ("sweep", sweep_file(tmp_path, 4), "--out", disk.folder / "o", "--executor", "serial")
    assert cli(*command)[0] == 0
    before = {name: (disk.folder / name).read_bytes() for name in files(disk.folder)}
    disk.change("ro")
    status, _, err = cli(*command)
    assert status == 2
    assert "Read-only file system" in err
    assert {name: (disk.folder / name).read_bytes() for name in files(disk.folder)} == before


@pytest.mark.parametrize("command", COMMANDS, ids=named)
@pytest.mark.parametrize("size", ["16k", "120k"])
def test_a_full_disk_costs_no_result(cli, disk, command, size):
    """It is refused before the work, or the result is complete in the folder that is named."""
    disk.mount(f"size={size}")
    status, out, err = cli(*command, "--out", disk.folder / "o")
    if status == 0:
        place = Path(re.search(r"(?:Results|Report|Certificate) in (\S+?),", out)[1])
        assert place.exists()
    else:
        assert status == 2
        assert "No space left on device" in err or "cannot be written" in err


def sweep(cli, quick, folder):
    return cli("sweep", quick, "--out", folder, "--executor", "serial")


@pytest.mark.slow
def test_a_sweep_that_fills_the_disk_keeps_its_runs_and_goes_on_when_there_is_room(cli, disk, quick, tmp_path):
    disk.mount("size=100k")
    out = disk.folder / "o"
    status, _, err = sweep(cli, quick, out)
    assert status == 3
    assert "runs.sqlite: cannot be written: database or disk is full" in err
    assert "Finished runs are kept" in err
    disk.change("size=50m")
    status, said, _ = sweep(cli, quick, out)
    assert status == 0
    assert "40 runs in" in said
    assert sweep(cli, quick, tmp_path / "fresh")[0] == 0
    with xr.open_dataset(out / "sweep.nc") as found, xr.open_dataset(tmp_path / "fresh" / "sweep.nc") as wanted:
        xr.testing.assert_identical(found.load(), wanted.load())


def test_a_disk_that_holds_the_runs_but_not_their_dataset_loses_none(cli, disk, quick, tmp_path):
    assert sweep(cli, quick, tmp_path / "whole")[0] == 0
    database = (tmp_path / "whole" / "runs.sqlite").stat().st_size
    disk.mount(f"size={database // 1024 + 24}k")
    out = disk.folder / "o"
    out.mkdir()
    for name in ("runs.sqlite", "runs.lock"):
        shutil.copy(tmp_path / "whole" / name, out / name)
    status, _, err = sweep(cli, quick, out)
    assert status == 3
    assert "sweep.nc: cannot be written" in err
    assert files(out) == ["runs.lock", "runs.sqlite"]
    disk.change("size=50m")
    assert sweep(cli, quick, out)[0] == 0


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="no limits of resources")
def test_a_limit_on_the_size_of_files_stops_a_sweep_in_words(quick, tmp_path):
    """Where nothing can be mounted, this is as good as a full disk."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))

    arguments = ("sweep", quick, "--out", tmp_path / "o", "--executor", "serial")
    status, _, err = ended(started(*arguments, cwd=tmp_path, preexec_fn=limit))
    assert status == 3
    assert "runs.sqlite: cannot be written" in err
    assert "Finished runs are kept" in err
    assert ended(started(*arguments, cwd=tmp_path)).status == 0


def test_a_result_on_a_full_disk_measures_the_same(cli, disk, tmp_path):
    """What a full disk sends elsewhere is whole."""
    disk.mount("size=120k")
    status, out, _ = cli(*RUN, "--out", disk.folder / "o")
    assert status == 0
    (folder,) = {line.split("Results in ")[1].split(", ")[0] for line in out.splitlines() if "Results in " in line}
    with xr.open_dataset(f"{folder}/result.nc") as result:
        found = metrics(result.load())
    assert cli(*RUN, "--out", tmp_path / "o")[0] == 0
    with xr.open_dataset(tmp_path / "o" / "result.nc") as result:
        assert metrics(result.load()) == found
    shutil.rmtree(folder)
