"""``drake-formation view`` writes pages, of scenarios and of results, and says what it cannot show."""

import socket
from pathlib import Path

import pytest
import xarray as xr

from drake_formation import load_scenario, simulate

SHORT = ["--set", "aggregation.duration=1", "--set", "transport.duration=2"]


def test_a_scenario_and_its_result_are_the_same_page(cli):
    assert cli("view", "line", *SHORT, "--html", "scenario.html")[0] == 0
    Path("run").mkdir()
    simulate(load_scenario("line", overrides=SHORT[1::2])).to_netcdf("run/result.nc")
    for source in ("run", "run/result.nc"):
        status, out, _ = cli("view", source, "--html", "result.html")
        assert (status, out.strip()) == (0, "The view is in result.html.")
        assert Path("result.html").read_text() == Path("scenario.html").read_text()


def test_what_cannot_be_shown_is_named(cli):
    Path("bad.nc").write_text("no result")
    for arguments, message in (
        (["bad.nc"], "bad.nc: cannot be read"),
        (["none.nc"], "none.nc: cannot be read: No such file"),
        (["lime"], "'line'"),
        (["bad.nc", *SHORT], "--set goes with a scenario"),
        (["line", "--set", "robots.mass=-1"], "robots.mass"),
    ):
        status, _, err = cli("view", *arguments, "--html", "view.html")
        assert status == 2
        assert message in err
        assert not Path("view.html").exists()


def test_a_place_that_cannot_be_written_is_refused_before_anything_runs(cli):
    status, _, err = cli("view", "line", "--html", "nowhere/view.html")
    assert status == 2
    assert "nowhere/view.html" in err


def test_a_port_that_is_taken_is_named(cli):
    with socket.socket() as taken:
        taken.bind(("localhost", 0))
        taken.listen()
        port = taken.getsockname()[1]
        status, _, err = cli("view", "line", *SHORT, "--no-browser", "--port", port)
    assert status == 2
    assert f"port {port}" in err


@pytest.mark.parametrize("how", [["--html", "view.html"], ["--no-browser"]])
def test_a_file_that_is_no_result_is_refused(cli, how):
    xr.Dataset({"position": 1.0}).to_netcdf("other.nc")
    status, _, err = cli("view", "other.nc", *how)
    assert status == 2
    assert "not a result of this version" in err
