"""Faults of the machine, as a command meets them: each ends in the right result, or in a message and an exit status."""

import os
import subprocess
import sys
from collections import namedtuple
from pathlib import Path

import pytest
from sweep.quick import QUICK

Ended = namedtuple("Ended", "status out err")

RUN = ("run", "line", "--engine", "compiled", *(f"--set={name}=0.3" for name in QUICK if name.endswith("duration")))

SWEEP = """\
name: mine
scenario: line
set: {aggregation.duration: 0.5, transport.duration: 0.5, robots.start: {centre: [2.5, 3.5]}}
axes:
  - path: springs.stiffness
    logspace: [1.0, 1.0e+4, POINTS]
trajectories: {variables: [position, velocity, control_force], every: 0.005}
"""


def started(*arguments, **settings):
    """The command as a process."""
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen([sys.executable, "-m", "drake_formation", *map(str, arguments)], **(streams | settings))


def ended(process):
    """How a command ended; never with a traceback."""
    out, err = process.communicate(timeout=300)
    assert "Traceback" not in out + err
    assert "Fatal Python error" not in err
    return Ended(process.returncode, out, err)


def sweep_file(folder, points=40):
    """A sweep of so many quick runs of some 10 kB each."""
    path = folder / "mine.yaml"
    path.write_text(SWEEP.replace("POINTS", str(points)))
    return path


class Disk:
    """A disk of its own at a folder."""

    def __init__(self, folder):
        self.folder = folder

    def mount(self, *options):
        command = ["mount", "-t", "tmpfs", "-o", ",".join(options), "tmpfs", str(self.folder)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            pytest.skip(f"mounting is not permitted here: {done.stderr.strip()}")

    def change(self, *options):
        subprocess.run(["mount", "-o", ",".join(["remount", *options]), str(self.folder)], check=True)

    def unmount(self):
        subprocess.run(["umount", "-l", str(self.folder)], check=False, capture_output=True)


@pytest.fixture
def disk(tmp_path):
    """A disk that can be small or read-only, not mounted yet."""
    if sys.platform != "linux" or os.geteuid() != 0:
        pytest.skip("mounting takes Linux and root")
    folder = tmp_path / "disk"
    folder.mkdir()
    disk = Disk(folder)
    yield disk
    disk.unmount()


@pytest.fixture
def quick(tmp_path):
    """The quick sweep's file."""
    return sweep_file(tmp_path)


def files(folder):
    """Names of the files in a folder and below, hidden ones included."""
    return sorted(str(path.relative_to(folder)) for path in Path(folder).rglob("*") if path.is_file())
