"""The command line: what each command does, and that no fault reaches the user as a traceback."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

SHORT = ["--set", "aggregation.duration=2", "--set", "transport.duration=3"]
DIVERGING = [
    "--set", "simulator.integration_scheme=explicit_euler",
    "--set", "simulator.use_error_control=false",
    "--set", "consensus.delta=1e4",
]  # fmt: skip


def test_run_writes_everything_and_says_where(cli):
    status, out, _ = cli("run", "line", *SHORT, "--out", "results/line")
    folder = Path("results/line")
    assert status == 0
    assert "peak control force" in out
    assert "results/line" in out
    assert sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()) == [
        "diagram.dot",
        "diagram.svg",
        "figures/consensus_error.png",
        "figures/control_forces.png",
        "figures/overview.png",
        "figures/paths.png",
        "figures/spring_lengths.png",
        "figures/tracking_error.png",
        "metrics.json",
        "result.nc",
        "scenario.yaml",
    ]
    measured = json.loads((folder / "metrics.json").read_text())
    assert [event["kind"] for event in measured["events"]] == ["hand_off"]
    assert measured["events"][0]["sentence"] in out
    assert set(measured) >= {
        "tracking_error_m",
        "consensus_error_m",
        "peak_force_n",
        "min_clearance_m",
        "max_spring_strain",
        "settling_time_s",
    }
    with xr.open_dataset(folder / "result.nc") as result:
        assert result["position"].dims == ("time", "robot", "axis")
        assert result["control_force"].attrs["units"] == "N"


@pytest.mark.parametrize(("suffix", "magic"), [("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_figures_are_written_in_the_format_asked_for(cli, suffix, magic):
    assert cli("run", "line", *SHORT, "--format", suffix, "--out", "o")[0] == 0
    files = list(Path("o/figures").iterdir())
    assert len(files) == 6
    assert all(file.suffix == f".{suffix}" and file.read_bytes().startswith(magic) for file in files)


def test_a_format_of_no_figure_is_refused_before_anything_runs(cli):
    status, _, err = cli("run", "line", *SHORT, "--format", "gif", "--out", "o")
    assert status == 2
    assert "'gif'" in err
    assert not Path("o").exists()


def test_run_of_the_resolved_scenario_repeats_the_run(cli):
    cli("run", "line", *SHORT, "--set", "springs.stiffness=30", "--out", "first")
    assert cli("run", "first/scenario.yaml", "--out", "second")[0] == 0
    with xr.open_dataset("first/result.nc") as first, xr.open_dataset("second/result.nc") as second:
        xr.testing.assert_identical(first, second)
    assert Path("first/metrics.json").read_text() == Path("second/metrics.json").read_text()


def test_run_goes_to_out_and_the_scenarios_name_by_default(cli):
    assert cli("run", "line", *SHORT)[0] == 0
    assert Path("out/line/metrics.json").exists()


def test_a_wrong_scenario_is_refused_before_anything_runs(cli):
    status, _, err = cli("run", "line", "--set", "springs.stifness=1", "--set", "robots.mass=-1", "--out", "o")
    assert status == 2
    assert "springs.stifness" in err
    assert "did you mean 'stiffness'?" in err
    assert "robots.mass" in err
    assert len(err.strip().splitlines()) == 2
    assert not Path("o").exists()


def test_a_wrong_file_is_named_with_its_line(cli):
    Path("mine.yaml").write_text("name: mine\nformation: {shape: line, robots: 2, side: -1}\n")
    status, _, err = cli("validate", "mine.yaml")
    assert status == 2
    assert "mine.yaml:2: formation.side" in err


@pytest.mark.parametrize("command", ["run", "validate"])
def test_an_unknown_scenario_is_refused_with_the_nearest_name(cli, command):
    status, _, err = cli(command, "lime")
    assert status == 2
    assert "'line'" in err


def test_a_diverging_run_keeps_what_it_recorded(cli):
    status, _, err = cli("run", "line", *DIVERGING, "--out", "o")
    assert status == 3
    assert "t = " in err
    assert "robot " in err
    assert "simulator.max_step_size" in err
    assert not Path("o").exists()
    assert (Path("o.failed") / "failure.txt").read_text().strip() in err
    with xr.open_dataset("o.failed/result.nc") as partial:
        assert partial.sizes["time"] > 1


def test_a_failed_run_leaves_an_earlier_result_alone(cli):
    cli("run", "line", *SHORT, "--out", "o")
    before = Path("o/metrics.json").read_text()
    assert cli("run", "line", *DIVERGING, "--out", "o")[0] == 3
    assert Path("o/metrics.json").read_text() == before


def test_a_folder_that_holds_something_else_is_refused(cli):
    Path("precious").mkdir()
    Path("precious/thesis.tex").write_text("…")
    status, _, err = cli("run", "line", *SHORT, "--out", "precious")
    assert status == 2
    assert "precious" in err
    assert Path("precious/thesis.tex").exists()


@pytest.mark.parametrize("suffix", ["dot", "svg", "png", "pdf"])
def test_graphviz_draws_the_diagram(cli, suffix):
    assert cli("graphviz", "line", "-o", f"line.{suffix}", "--depth", "2")[0] == 0
    assert Path(f"line.{suffix}").stat().st_size > 1000


@pytest.mark.parametrize("suffix", ["dot", "svg", "png", "pdf"])
def test_graphviz_draws_the_formation(cli, suffix):
    assert cli("graphviz", "line", "-o", f"line.{suffix}", "--view", "formation")[0] == 0
    assert Path(f"line.{suffix}").stat().st_size > 1000


def test_graphviz_refuses_a_depth_of_the_formation(cli):
    status, _, err = cli("graphviz", "line", "-o", "line.svg", "--view", "formation", "--depth", "2")
    assert status == 2
    assert "--depth" in err
    assert not Path("line.svg").exists()


@pytest.mark.parametrize("output", ["line.gif", "missing/line.svg"])
def test_graphviz_refuses_what_it_cannot_write(cli, output):
    status, _, err = cli("graphviz", "line", "-o", output)
    assert status == 2
    assert err.strip()


def test_schema_is_json(cli):
    status, out, _ = cli("schema")
    assert status == 0
    assert "springs" in json.loads(out)["properties"]


def test_validate_says_what_it_read(cli):
    status, out, _ = cli("validate", "quadrilateral")
    assert status == 0
    assert "1-2 1-3 1-4 2-3 2-4 3-4" in out


def test_the_module_is_the_command():
    done = subprocess.run(
        [sys.executable, "-m", "drake_formation", "validate", "nothing"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2
    assert "nothing" in done.stderr
    assert "Traceback" not in done.stderr


def test_reproduce_writes_a_report(cli):
    status, out, _ = cli("reproduce", "--only", "table1", "--out", "paper")
    assert status == 0
    assert "paper/report.html" in out
    assert Path("paper/report.html").exists()


def test_reproduce_names_the_nearest_part(cli):
    status, _, err = cli("reproduce", "--only", "tabel3")
    assert status == 2
    assert "did you mean 'table3'" in err


@pytest.mark.parametrize("other", [["--topologies"], ["--cell", "table5:steel:0"]])
def test_reproduce_does_one_thing(cli, other):
    status, _, err = cli("reproduce", "--only", "table3", *other)
    assert status == 2
    assert "give one of them" in err


def test_reproduce_refuses_a_cell_that_is_not_there(cli):
    status, _, err = cli("reproduce", "--cell", "table5:wood:0")
    assert status == 2
    assert "rubber, steel" in err


def test_validate_shows_each_robots_own_values(cli):
    status, out, _ = cli("validate", "line", "--set", "robots.mass={1: 50.0, default: 40.0}")
    assert status == 0
    assert "50.0" in out
    assert "hookean" in out


def test_run_and_validate_warn_of_a_failure_that_never_comes(cli):
    late = ("--set", "failures=[{robot: 1, time: 500, kind: freezes}]")
    for command in (("run", "line", *SHORT, *late, "--out", "o"), ("validate", "line", *SHORT, *late)):
        status, out, _ = cli(*command)
        assert status == 0
        assert "warning: failures.0.time: the scenario ends at" in out
        assert "the robot never fails" in out


def test_events_of_a_run_are_told_and_written(cli):
    fails = "failures=[{robot: 1, time: 2.0, kind: stops_actuating}]"
    status, out, _ = cli("run", "line", *SHORT, "--set", fails, "--out", "o")
    assert status == 0
    told = json.loads(Path("o/metrics.json").read_text())["events"]
    assert [event["kind"] for event in told] == ["hand_off", "failure"]
    assert "robot 1 stops actuating" in out
