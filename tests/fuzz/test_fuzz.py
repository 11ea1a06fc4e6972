"""Mutated commands, the same ones each time, end in a message, an exit status and a result."""

import subprocess
import sys
from pathlib import Path

import pytest

CASES = 40


@pytest.mark.slow
def test_no_command_ends_in_a_traceback_or_never():
    """In a process of its own: what it forks has no threads, and no more memory than a command needs."""
    command = [sys.executable, "-m", "fuzz", "--seed", "1", "--count", str(CASES)]
    done = subprocess.run(command, cwd=Path(__file__).parents[1], capture_output=True, text=True, check=False)
    assert not done.returncode, done.stdout + done.stderr
    assert f"of {CASES} tried" in done.stdout
