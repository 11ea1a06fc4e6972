"""Watching processes and sweeps' folders from outside."""

import sqlite3
import time
from pathlib import Path

from drake_formation.sweep.store import DATABASE


def gone(pid, seconds=20.0):
    """Whether a process ends within some seconds."""
    for _ in range(round(seconds / 0.05)):
        try:
            if Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z":
                return True
        except OSError:
            return True
        time.sleep(0.05)
    return False


def count(folder):
    """How many runs a sweep's folder holds."""
    try:
        with sqlite3.connect(f"file:{folder / DATABASE}?mode=ro", uri=True, timeout=5) as database:
            return database.execute("SELECT count(*) FROM runs").fetchone()[0]
    except sqlite3.Error:
        return 0
