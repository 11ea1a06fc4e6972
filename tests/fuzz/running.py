"""Running a command many times: each in a fork of a process that has imported everything."""

import os
import re
import resource
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from fuzz.mutations import Case

TIME_LIMIT = 20.0
MEMORY = 6 * 2**30

REFUSED, RAN, FAILED, TRACEBACK, HANG, SILENT = (
    "refused well",
    "ran",
    "failed run",
    "traceback",
    "hang",
    "without a word",
)
FAULTS = (TRACEBACK, HANG, SILENT)


@dataclass
class Outcome:
    """What a command did.

    Attributes:
        verdict: one of the words above.
        status: exit status; negative for a signal.
        output: what it printed.
    """

    verdict: str
    status: int
    output: str


def carry_out(case: Case, time_limit: float = TIME_LIMIT) -> Outcome:
    """Run a case in a folder of its own."""
    with _temporary_folder() as folder:
        for file, text in case.files.items():
            (folder / file).write_bytes(text.encode("utf-8", "surrogatepass"))
        here = folder / "here"
        here.mkdir()
        _furnish(here)
        output = folder / "output"
        pid = os.fork()
        if not pid:
            _child(case, folder, output)
        status = _wait(pid, time_limit)
        text = output.read_text(encoding="utf-8", errors="replace") if output.exists() else ""
    return Outcome(_verdict(status, text), status if status is not None else -9, text)


@contextmanager
def _temporary_folder() -> Iterator[Path]:
    """As tempfile's, however deep the folders in it are."""
    folder = tempfile.mkdtemp(prefix="fuzz-")
    try:
        yield Path(folder)
    finally:
        subprocess.run(["rm", "-rf", folder], check=False)


def _furnish(here: Path) -> None:
    """What a folder may hold that is in the way."""
    (here / "file").touch()
    (here / "loop").symlink_to("loop")
    (here / "dangling").symlink_to("nowhere")
    (here / "full").mkdir()
    (here / "full" / "thesis.tex").touch()


def _child(case: Case, folder: Path, output: Path) -> None:
    status = 1
    try:
        os.setsid()
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        os.chdir(folder / "here")
        descriptor = os.open(output, os.O_WRONLY | os.O_CREAT)
        os.dup2(descriptor, 1)
        os.dup2(descriptor, 2)
        for number, stream in ((1, "stdout"), (2, "stderr")):
            setattr(sys, stream, open(number, "w", encoding="utf-8", closefd=False))  # noqa: SIM115
        status = _main(["../s.yaml" if word == "s.yaml" else word for word in case.arguments])
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)


def _main(arguments: list[str]) -> int:
    import traceback

    from drake_formation.cli import main

    sys.argv = ["drake-formation", *arguments]
    try:
        main()
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


def _wait(pid: int, time_limit: float) -> int | None:
    """Exit status of a process, or None if it had to be ended."""
    descriptor = os.pidfd_open(pid)
    try:
        ready, _, _ = select.select([descriptor], [], [], time_limit)
        if not ready:
            os.killpg(pid, signal.SIGKILL)
        _, status = os.waitpid(pid, 0)
    finally:
        os.close(descriptor)
    return os.waitstatus_to_exitcode(status) if ready else None


def _verdict(status: int | None, text: str) -> str:
    if status is None:
        return HANG
    if re.search(r"Traceback|Warning:|Exception ignored|Fatal|Assertion", text) or status not in (0, 2, 3):
        return TRACEBACK
    if status and not text.strip():
        return SILENT
    return {0: RAN, 2: REFUSED, 3: FAILED}[status]


def warm_up() -> float:
    """Import everything a command needs, and run one; gives how long the latter took (s)."""
    import drake_formation.analysis.report
    import drake_formation.cli.certificate_folder
    import drake_formation.cli.run_folder
    import drake_formation.paper.reproduce
    import drake_formation.scenario.starter
    import drake_formation.sweep
    import drake_formation.viz.figures
    import drake_formation.viz.sketch
    import drake_formation.viz.sweep_figures  # noqa: F401

    begin = time.perf_counter()
    carry_out(Case(["validate", "line"]))
    return time.perf_counter() - begin
