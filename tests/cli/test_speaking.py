"""How commands speak: to people, to programs, at length or in short, and never in boxes or colours through a pipe."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from drake_formation.cli import app

SHORT = ["--set", "aggregation.duration=0.2", "--set", "transport.duration=0.3"]
SWEEP = """
name: small
scenario: line
set: {aggregation.duration: 0.2, transport.duration: 0.3}
axes: [{path: springs.stiffness, values: [1.0, 2.0]}]
"""
COMPARISON = """
name: small
scenario: line
set: {aggregation.duration: 0.2, transport.duration: 0.3}
laws: [{name: one}, {name: other, set: {consensus.delta: 10.0}}]
"""
FILES = {"small.yaml": SWEEP, "both.yaml": COMPARISON}

COMMANDS = {
    "run": ["run", "line", *SHORT, "--out", "run"],
    "export": ["export", "run", "--csv", "run.csv"],
    "view": ["view", "line", *SHORT, "--html", "line.html"],
    "new": ["new", "mine"],
    "show": ["show", "line"],
    "validate": ["validate", "line"],
    "sweep": ["sweep", "small.yaml", "--executor", "serial", "--out", "sweep"],
    "compare": ["compare", "both.yaml", "--workers", "1", "--out", "compare"],
    "analyze": ["analyze", "line"],
    "graphviz": ["graphviz", "line", "-o", "line.svg"],
    "reproduce": ["reproduce", "--only", "table1", "--out", "paper"],
    "list": ["list", "parts"],
    "schema": ["schema", "sweep"],
    "scenarios": ["scenarios"],
    "parts": ["parts"],
    "metrics": ["metrics"],
}
"""One way to use each command there is; one after the other, as some need what another wrote."""

ALL_IN_ONE = """
import json, sys
from drake_formation.cli import main
for arguments in json.loads(sys.argv[1]):
    sys.argv = ["drake-formation", *arguments]
    try:
        main()
    except SystemExit as end:
        if end.code:
            sys.exit(f"{arguments}: {end.code}")
"""


def _of_a_terminal_alone(text):
    """Escapes, and characters of boxes and blocks."""
    return re.findall(r"\x1b|[\u2500-\u259f]", text)


def test_every_command_is_tried():
    commands = {command.name or command.callback.__name__ for command in app.registered_commands}
    assert commands == COMMANDS.keys()


@pytest.mark.slow
def test_nothing_of_a_terminal_comes_through_a_pipe(tmp_path):
    for name, text in FILES.items():
        (tmp_path / name).write_text(text)
    helps = [["--help"], ["--version"], *([name, "--help"] for name in COMMANDS)]
    wanted = json.dumps([*COMMANDS.values(), *helps])
    environment = {key: value for key, value in os.environ.items() if key not in ("FORCE_COLOR", "TERM")}
    done = subprocess.run(
        [sys.executable, "-c", ALL_IN_ONE, wanted], cwd=tmp_path, env=environment | {"TERM": "xterm-256color"},
        capture_output=True, check=False,
    )  # fmt: skip
    out, err = done.stdout.decode(), done.stderr.decode()
    assert done.returncode == 0, err
    assert len(out.splitlines()) > 100
    assert not _of_a_terminal_alone(out)
    assert not _of_a_terminal_alone(err)
    assert [line for line in err.splitlines() if "deprecated" not in line] == []


@pytest.mark.parametrize(
    "name", [name for name in COMMANDS if name not in ("run", "export", "view", "schema", "reproduce", "compare")]
)
def test_a_program_gets_one_document_and_nothing_else(cli, name):
    Path("small.yaml").write_text(SWEEP)
    status, out, err = cli(*COMMANDS[name], "--json")
    assert status == 0
    assert isinstance(json.loads(out), dict)
    assert err == "" or name in ("scenarios", "parts", "metrics")


def test_what_a_run_tells_a_program_is_what_it_writes(cli):
    status, out, err = cli(*COMMANDS["run"], "--json")
    assert (status, err) == (0, "")
    told, written = json.loads(out), json.loads(Path("run/metrics.json").read_text())
    assert told["metrics"] == {name: value for name, value in written.items() if name != "events"}
    assert told["events"] == written["events"]
    assert (told["folder"], told["engine"]) == ("run", "blocks")


def test_a_program_gets_what_is_wrong_fault_by_fault(cli):
    status, out, err = cli("validate", "line", "--set", "springs.stifness=1", "--set", "robots.mass=-1", "--json")
    assert (status, out) == (2, "")
    faults = json.loads(err)["error"]["faults"]
    assert [fault["path"] for fault in faults] == [["robots", "mass"], ["springs", "stifness"]]
    assert faults[1]["suggestion"] == "stiffness"
    assert faults[1]["origin"] == "--set springs.stifness=1"


@pytest.mark.parametrize(
    ("words", "bare"),
    [
        (["-q", *COMMANDS["show"]], ""),
        ([*COMMANDS["show"], "-q"], ""),
        ([*COMMANDS["validate"], "--quiet"], ""),
        ([*COMMANDS["analyze"], "-q"], "stable\n"),
    ],
)
def test_in_short_there_is_the_bare_answer(cli, words, bare):
    assert cli(*words) == (0, bare, "")


def test_errors_stay(cli):
    status, out, err = cli("validate", "line", "--set", "robots.mass=-1", "-q")
    assert (status, out) == (2, "")
    assert "robots.mass" in err


def test_at_length_it_is_said_what_is_done_on_the_other_stream(cli):
    _, out, err = cli(*COMMANDS["run"], "-v")
    assert " s] " not in out
    for words in ("scenario: ", "line.yaml", "simulated by the engine blocks", "written: run"):
        assert words in err


def test_both_at_once_is_refused(cli):
    status, _, err = cli("validate", "line", "-q", "-v")
    assert status == 2
    assert "--quiet and --verbose" in err


def test_versions(cli):
    status, out, _ = cli("--version")
    assert status == 0
    assert re.fullmatch(r"drake-formation \d+\.\d+\.\d+\nDrake [\d.]+\nPython [\d.]+\w*\n", out)


@pytest.mark.parametrize("words", [["rnu", "line"], ["run", "line", "--egine", "blocks"]])
def test_a_man_in_a_hurry_is_told_what_he_meant(cli, words):
    status, _, err = cli(*words)
    assert status == 2
    assert ("run" if words[0] == "rnu" else "--engine") in err
