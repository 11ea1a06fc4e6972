"""``export`` writes a result in each format, ``run --csv`` a table beside the run; what is wrong is refused in time."""

import errno
from pathlib import Path

from drake_formation.exporting import csv_file
from drake_formation.viz import figures

SHORT = ["--set", "aggregation.duration=1", "--set", "transport.duration=2"]


def test_a_run_has_a_table_and_its_folder_is_exported(cli, monkeypatch):
    monkeypatch.setattr(figures, "write_figures", lambda *_: {})
    status, out, _ = cli("run", "line", *SHORT, "--out", "run", "--csv", "run.csv")
    assert status == 0
    assert "Table in run.csv." in out
    files = ["--csv", "again.csv", "--mat", "run.mat", "--mcap", "run.mcap"]
    status, out, _ = cli("export", "run", *files)
    assert status == 0
    assert out.splitlines() == ["Result in again.csv.", "Result in run.mat.", "Result in run.mcap."]
    assert Path("again.csv").read_text() == Path("run.csv").read_text()
    assert Path("run.mcap").read_bytes().startswith(b"\x89MCAP0\r\n")
    assert cli("export", "run/result.nc", "--csv", "springs.csv", "--of", "spring")[0] == 0
    assert Path("springs.csv").read_text().startswith("time (s),spring,spring_length (m)")
    status, _, err = cli("export", "run", "--csv", "nodes.csv", "--of", "node")
    assert (status, "no rows of 'node'" in err, Path("nodes.csv").exists()) == (2, True, False)


def test_a_disk_that_is_full_is_named_and_leaves_nothing(cli, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(figures, "write_figures", lambda *_: {})
    monkeypatch.setattr(csv_file, "write_csv", full)
    status, _, err = cli("run", "line", *SHORT, "--out", "run", "--csv", "run.csv")
    assert status == 2
    assert "run.csv: cannot be written: No space left" in err
    assert not list(Path().glob("*.csv"))
    status, _, err = cli("export", "run", "--csv", "run.csv")
    assert status == 2
    assert "run.csv: cannot be written: No space left" in err


def test_what_cannot_be_exported_is_named(cli):
    Path("bad.nc").write_text("no result")
    for arguments, message in (
        (["bad.nc"], "nothing to write"),
        (["bad.nc", "--csv", "a.csv"], "bad.nc: cannot be read"),
        (["none", "--mat", "a.mat"], "none: cannot be read: No such file"),
        (["bad.nc", "--mat", "a.mat", "--of", "spring"], "--of goes with --csv"),
    ):
        status, _, err = cli("export", *arguments)
        assert status == 2
        assert message in err
    assert [path.name for path in Path().iterdir()] == ["bad.nc"]


def test_a_table_that_cannot_be_written_is_refused_before_anything_runs(cli):
    status, _, err = cli("run", "line", *SHORT, "--out", "run", "--csv", "nowhere/run.csv")
    assert status == 2
    assert "nowhere" in err
    assert not Path("run").exists()
