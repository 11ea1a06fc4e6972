"""Finished runs on disk: one SQLite database a sweep, one row a run, committed before a run counts."""

import errno
import fcntl
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import IO, Self

import numpy as np
from numpy.typing import NDArray

from drake_formation.places import Kind, OutputError, make_folder
from drake_formation.sweep.errors import SweepError, SweepStoppedError
from drake_formation.sweep.rows import checksum, layout_of, packed, shapes_in, unpacked
from drake_formation.sweep.work import CODE, Outcome

DATABASE, LOCK = "runs.sqlite", "runs.lock"

_TABLES = """
CREATE TABLE IF NOT EXISTS meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS layouts (id INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE);
CREATE TABLE IF NOT EXISTS runs (point INTEGER PRIMARY KEY, error TEXT, layout INTEGER, numbers BLOB, checksum INTEGER);
"""


class Store:
    """The runs of one sweep in a folder; a context manager, which one process at a time may enter.

    A run's numbers are kept bit by bit, and a row that is not as it was written is noticed. The database's journal and
    its ``synchronous`` setting make a commit outlast the process, and the machine as far as its disk tells the truth.

    Args:
        folder: where; made if missing.
        identity: what the runs depend on, by name; runs of another identity are never mixed in.
    """

    def __init__(self, folder: Path, identity: dict[str, str]) -> None:
        self._folder = folder
        self._identity = identity
        self._layouts: dict[str, int] = {}

    def __enter__(self) -> Self:
        """Open the store.

        Raises:
            SweepError: the folder cannot be used, is in use, or holds something else.
        """
        _require_place(self._folder)
        self._lock = _lock(self._folder / LOCK)
        try:
            with self._explained("used"):
                self._database = sqlite3.connect(self._folder / DATABASE, isolation_level=None)
                self._prepare()
        except BaseException:
            self._lock.close()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the store and let others in."""
        self._database.close()
        self._lock.close()

    def add(self, outcomes: Sequence[Outcome]) -> None:
        """Keep outcomes; on return they are on disk. A run that was kept before is replaced.

        Raises:
            SweepStoppedError: they cannot be written.
        """
        try:
            with self._transaction():
                self._database.executemany(
                    "INSERT OR REPLACE INTO runs VALUES (?, ?, ?, ?, ?)", map(self._row, outcomes)
                )
        except sqlite3.Error as error:
            self._layouts.clear()
            raise SweepStoppedError(f"{self._folder / DATABASE}: cannot be written: {error}") from error

    def kept(self, size: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Which of so many points have finished, and which of these failed."""
        finished, failed = np.zeros(size, bool), np.zeros(size, bool)
        with self._explained("read"):
            for point, wrong in self._database.execute("SELECT point, error IS NOT NULL FROM runs"):
                finished[point], failed[point] = True, wrong
        return finished, failed

    def outcomes(self, first: int, last: int) -> Iterator[Outcome]:
        """Outcomes of the points from a first up to, not including, a last, in order.

        Raises:
            SweepError: they cannot be read, or are not as they were written.
        """
        query = "SELECT point, error, layout, numbers, checksum FROM runs WHERE point >= ? AND point < ? ORDER BY point"
        with self._explained("read"):
            layouts = dict(self._database.execute("SELECT id, text FROM layouts"))
            for point, error, key, numbers, wanted in self._database.execute(query, (first, last)):
                layout = layouts.get(key)
                if checksum(point, error, layout, numbers) != wanted:
                    raise self._damaged(f"run {point} is not as it was written")
                yield Outcome(point, error, {} if layout is None else unpacked(layout, numbers))

    def shapes(self) -> dict[str, tuple[int, ...]]:
        """For each name of a value the largest shape of any run."""
        largest: dict[str, tuple[int, ...]] = {}
        with self._explained("read"):
            for (text,) in self._database.execute("SELECT text FROM layouts WHERE id IN (SELECT layout FROM runs)"):
                for name, shape in shapes_in(text).items():
                    sizes = zip(shape, largest.get(name, shape), strict=True)
                    largest[name] = tuple(max(pair) for pair in sizes)
        return largest

    def failures(self) -> Iterator[tuple[int, str]]:
        """Numbers of the failed points with their errors, in order."""
        with self._explained("read"):
            yield from self._database.execute("SELECT point, error FROM runs WHERE error IS NOT NULL ORDER BY point")

    def _prepare(self) -> None:
        # A rollback journal, not a write-ahead log, which network file systems do not have.
        self._database.execute("PRAGMA journal_mode = DELETE")
        self._database.execute("PRAGMA synchronous = EXTRA")
        (state,) = self._database.execute("PRAGMA quick_check(1)").fetchone()
        if state != "ok":
            raise self._damaged(state)
        with self._transaction():
            for statement in filter(str.strip, _TABLES.split(";")):
                self._database.execute(statement)
            known = dict(self._database.execute("SELECT key, value FROM meta"))
            (any_runs,) = self._database.execute("SELECT EXISTS (SELECT 1 FROM runs)").fetchone()
            if not any_runs:
                self._database.execute("DELETE FROM meta")
                self._database.executemany("INSERT INTO meta VALUES (?, ?)", self._identity.items())
        if any_runs and (different := [key for key, value in self._identity.items() if known.get(key) != value]):
            raise SweepError(f"{self._folder}: holds {_difference(different, known, self._identity)}")

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._database.execute("BEGIN IMMEDIATE")
        try:
            yield
            self._database.execute("COMMIT")
        except BaseException:
            self._database.rollback()
            raise

    def _row(self, outcome: Outcome) -> tuple[int, str | None, int | None, bytes | None, int]:
        """A row of an outcome; which values it has is said once for all runs that have the same."""
        point, error = outcome.index, outcome.error
        if error is not None:
            return point, error, None, None, checksum(point, error, None, None)
        layout, numbers = layout_of(outcome.values), packed(outcome.values)
        if layout not in self._layouts:
            self._database.execute("INSERT OR IGNORE INTO layouts (text) VALUES (?)", (layout,))
            (self._layouts[layout],) = self._database.execute(
                "SELECT id FROM layouts WHERE text = ?", (layout,)
            ).fetchone()
        return point, None, self._layouts[layout], numbers, checksum(point, None, layout, numbers)

    @contextmanager
    def _explained(self, doing: str) -> Iterator[None]:
        """What SQLite says, as a SweepError that names the file."""
        try:
            yield
        except sqlite3.OperationalError as error:
            raise SweepError(f"{self._folder / DATABASE}: cannot be {doing}: {error}") from error
        except (sqlite3.Error, IndexError) as error:
            raise self._damaged(str(error)) from error

    def _damaged(self, how: str) -> SweepError:
        advice = "move it away to run the sweep anew, or give another folder"
        return SweepError(f"{self._folder / DATABASE}: is damaged ({how}); {advice}")


def _require_place(folder: Path) -> None:
    """Make a folder, unless it holds something else than a sweep."""
    try:
        make_folder(folder, Kind(LOCK, (LOCK, DATABASE)))
    except OutputError as error:
        raise SweepError(str(error)) from error


def _lock(path: Path) -> IO[str]:
    """An open file that no other process can lock until it is closed, or its process gone."""
    try:
        file = path.open("w")
    except OSError as error:
        raise SweepError(f"{path}: cannot be written: {error.strerror}") from error
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        if error.errno in (errno.EAGAIN, errno.EACCES):
            raise SweepError(f"{path.parent}: another process is sweeping into this folder; wait for it") from error
        raise SweepError(f"{path}: cannot be locked: {error.strerror}") from error
    return file


def _difference(different: Sequence[str], known: dict[str, str], wanted: dict[str, str]) -> str:
    if "sweep" in different:
        return "the runs of another sweep (base scenario, values or sampling differ); give another folder"
    if CODE in wanted and CODE not in known:
        return "runs of an earlier version, which did not note by which code they were made; give another folder"
    changes = ", ".join(f"{key} {known.get(key)}, now {wanted[key]}" for key in different)
    back = ", or go back to the code that made them" if CODE in different else ""
    return f"runs made otherwise ({changes}), which may differ; give another folder{back}"
