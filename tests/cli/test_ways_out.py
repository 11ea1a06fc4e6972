"""Every way out of every command is a message, an exit status and the record: as a user's shell sees it."""

import json
import os
import signal
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytestmark = pytest.mark.slow  # dozens of processes

SHORT = ["--set", "aggregation.duration=0.2", "--set", "transport.duration=0.3"]
RUN = ["run", "line", *SHORT]
SWEEP = """
name: small
scenario: line
set: {aggregation.duration: 0.2, transport.duration: 0.3}
axes: [{path: springs.stiffness, values: [1.0, 2.0]}]
"""


@pytest.fixture
def command(tmp_path):
    """Run the command in an empty folder; gives the exit status, standard output and standard error."""

    def run(*arguments, shell="", **environment):
        words = [sys.executable, "-m", "drake_formation", *map(str, arguments)]
        if shell:
            words = ["bash", "-c", f'"$@" {shell}', "bash", *words]
        done = subprocess.run(
            words, cwd=tmp_path, env=os.environ | environment, capture_output=True, check=False, timeout=120
        )
        out, err = done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")
        assert "Traceback" not in out + err
        return done.returncode, out, err

    return run


LOCALES = {
    "ascii": {"PYTHONIOENCODING": "ascii"},
    "ascii, strictly": {"PYTHONIOENCODING": "ascii:strict"},
    "latin-1": {"PYTHONIOENCODING": "latin-1"},
    "cp1252": {"PYTHONIOENCODING": "cp1252"},
    "C": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


@pytest.mark.parametrize("locale", LOCALES)
def test_what_a_terminal_cannot_show_is_spelt_out(command, tmp_path, locale):
    status, out, _ = command("validate", "line", **LOCALES[locale])
    assert status == 0
    assert "delta = 0 N/m" in out
    rows = out.splitlines()[2:]
    assert len(rows) > 8
    assert len({len(row) - len(row.split("  ")[-1].lstrip()) for row in rows}) == 1  # where the second column begins


@pytest.mark.parametrize("locale", ["ascii, strictly", "C"])
def test_files_are_utf8_in_any_locale(command, tmp_path, locale):
    assert command(*RUN, "--out", "o", **LOCALES[locale])[0] == 0
    status, out, _ = command("analyze", "line", "--out", "certificate", **LOCALES[locale])
    assert status == 0
    assert "delta" in out
    for name in ("o/metrics.json", "o/scenario.yaml", "o/diagram.svg", "certificate/certificate.json"):
        (tmp_path / name).read_text(encoding="utf-8")


@pytest.mark.parametrize("arguments", [["schema"], ["validate", "line"], RUN])
def test_a_reader_that_leaves_is_no_fault(command, arguments):
    status, _, err = command(*arguments, shell="| true; exit ${PIPESTATUS[0]}")
    assert status in (0, 141)
    assert not err.strip()


def test_a_closed_or_full_standard_output_costs_nothing(command, tmp_path):
    assert command(*RUN, "--out", "closed", shell=">&-")[0] == 0
    assert command(*RUN, "--out", "all", shell="<&- >&- 2>&-")[0] == 0
    status, _, err = command(*RUN, "--out", "full", shell="> /dev/full")
    assert status == 2
    assert "standard output" in err
    assert all((tmp_path / name / "metrics.json").exists() for name in ("closed", "all", "full"))


@pytest.mark.parametrize("setting", [{"COLUMNS": "1"}, {"TERM": "dumb", "FORCE_COLOR": "1"}])
def test_any_terminal_will_do(command, setting):
    assert command("validate", "line", **setting)[0] == 0


COMMANDS = {
    "run": [
        *("run", "line", "--engine", "blocks", "--out", "o"),
        *("--set", "transport.duration=1e4", "--set", "simulator.max_step_size=1e-3"),
    ],
    "sweep": ["sweep", "gains", "--out", "o", "--workers", "1"],
    "analyze": ["analyze", "octagon", "--out", "o"],
}


@pytest.mark.parametrize(
    ("name", "kind", "delay"),
    [
        ("run", signal.SIGINT, 0.6),
        ("run", signal.SIGINT, 3.0),
        ("run", signal.SIGTERM, 4.0),
        ("run", signal.SIGHUP, 3.0),
        ("sweep", signal.SIGINT, 4.0),
        ("sweep", signal.SIGTERM, 4.0),
        ("analyze", signal.SIGTERM, 2.0),
    ],
)
def test_a_signal_ends_a_command_in_good_order(tmp_path, name, kind, delay):
    process = subprocess.Popen(
        [sys.executable, "-m", "drake_formation", *COMMANDS[name]],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, process_group=0,
        preexec_fn=lambda: signal.signal(kind, signal.SIG_DFL),  # noqa: PLW1509 (else as what started the tests has it)
    )  # fmt: skip
    time.sleep(delay)
    os.killpg(process.pid, kind)  # as a terminal does
    try:
        out, err = process.communicate(timeout=60)
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == 128 + kind
    assert "Traceback" not in out + err
    assert err.strip().startswith(("interrupted", "terminated"))
    assert {path.name for path in tmp_path.iterdir()} <= ({"o"} if name == "sweep" else set())


def test_a_record_goes_elsewhere_if_its_name_is_taken(command, tmp_path):
    (tmp_path / "o.failed").mkdir()
    (tmp_path / "o.failed" / "thesis.tex").touch()
    diverging = [
        "simulator.integration_scheme=explicit_euler",
        "simulator.use_error_control=false",
        "consensus.delta=1e4",
    ]
    status, _, err = command("run", "line", *[word for text in diverging for word in ("--set", text)], "--out", "o")
    assert status == 3
    assert "o.failed holds something else" in err
    assert "o.failed-2" in err
    assert (tmp_path / "o.failed-2" / "failure.txt").exists()
    assert [path.name for path in (tmp_path / "o.failed").iterdir()] == ["thesis.tex"]


OUTS = ["", "file", "a" * 300, "loop", "dangling", "file/run", "/dev/null", "/", "a\nb/" + "c" * 300]
ELSE = [["analyze", "line"], ["reproduce", "--only", "table1"], ["sweep", "small.yaml"]]


@pytest.mark.parametrize(
    ("arguments", "out"),
    [*((RUN, out) for out in OUTS), *((other, out) for other in ELSE for out in (OUTS[2], OUTS[-1]))],
)
def test_a_place_that_will_not_do_is_refused(command, tmp_path, arguments, out):
    (tmp_path / "file").touch()
    (tmp_path / "loop").symlink_to("loop")
    (tmp_path / "dangling").symlink_to("nowhere")
    (tmp_path / "small.yaml").write_text(SWEEP)
    status, _, err = command(*arguments, "--out", out)
    assert status == 2
    assert err.strip()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["dangling", "file", "loop", "small.yaml"]


@pytest.mark.parametrize("arguments", [RUN, ["analyze", "line"], ["reproduce", "--only", "table1"]])
def test_an_empty_current_folder_will_do(command, tmp_path, arguments):
    status, out, _ = command(*arguments, "--out", ".")
    assert status == 0
    assert "in ." in out or "in report.html" in out
    assert len(list(tmp_path.iterdir())) > 2


@pytest.mark.parametrize(
    "settings", ["text.usetex: True", "backend: nonsense\nfont.family: Nothing", "savefig.dpi: 1e9"]
)
def test_settings_of_matplotlib_cost_no_picture(command, tmp_path, settings):
    (tmp_path / "matplotlibrc").write_text(settings)
    status, out, _ = command(*RUN, "--out", "o", MATPLOTLIBRC=str(tmp_path), MPLBACKEND="nonsense")
    assert status == 0
    assert "No figure" not in out
    assert len(list((tmp_path / "o" / "figures").glob("*.png"))) == 6


def test_a_picture_that_fails_costs_only_itself(command, tmp_path):
    (tmp_path / "matplotlib.py").write_text("raise RuntimeError('out of order')")
    paths = os.pathsep.join(filter(None, [str(tmp_path), os.environ.get("PYTHONPATH")]))
    status, out, _ = command(*RUN, "--out", "o", PYTHONPATH=paths)
    assert status == 0
    assert "No figure figures: out of order." in out
    assert json.loads((tmp_path / "o" / "metrics.json").read_text())["peak_force_n"] > 0
    assert (tmp_path / "o" / "result.nc").exists()


def test_results_are_readable_as_the_users_mask_says(command, tmp_path):
    command(*RUN, "--out", "o")
    mask = os.umask(0)
    os.umask(mask)
    assert stat.S_IMODE((tmp_path / "o").stat().st_mode) == 0o777 & ~mask


@pytest.mark.parametrize("source", ["/dev/zero", "pipe", "large", "bomb", "deep", "", "a" * 300])
@pytest.mark.parametrize("arguments", [["validate"], ["sweep", "--out", "o"]])
def test_what_is_no_scenario_is_refused_at_once(command, tmp_path, source, arguments):
    os.mkfifo(tmp_path / "pipe")
    with (tmp_path / "large").open("wb") as file:
        file.truncate(10**8)
    doubled = [f"{name}: &{name} [{f'*{former}, ' * 9}]" for former, name in zip("abcdefgh", "bcdefghi", strict=True)]
    (tmp_path / "bomb").write_text("\n".join(["a: &a [1, 2]", *doubled]))
    (tmp_path / "deep").write_text("a: " + "[" * 100_000)
    status, _, err = command(arguments[0], source, *arguments[1:])
    assert status == 2
    assert err.strip()
    assert not Path(tmp_path / "o").exists()
