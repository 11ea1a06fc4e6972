"""Finished runs on disk: one SQLite database a sweep, one row a run, committed before a run counts."""

import fcntl
import json
import sqlite3
import zlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import IO, Self

import numpy as np
from numpy.typing import NDArray

from drake_formation.places import Kind, OutputError, make_folder
from drake_formation.sweep.errors import SweepError, SweepStoppedError
from drake_formation.sweep.work import Outcome

DATABASE, LOCK = "runs.sqlite", "runs.lock"

_TABLES = """
CREATE TABLE IF NOT EXISTS meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS layouts (id INTEGER PRIMARY KEY, text TEXT NOT NULL UNIQUE);
CREATE TABLE IF NOT EXISTS runs (point INTEGER PRIMARY KEY, error TEXT, layout INTEGER, numbers BLOB);
"""
_COMPRESSED = 128
"""Rows of more numbers than this are compressed."""


class Store:
    """The runs of one sweep in a folder; a context manager, which one process at a time may enter.

    A run's numbers are kept bit by bit. The database's journal and its ``synchronous`` setting make a commit outlast
    the process, and the machine as far as its disk tells the truth.

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
            self._database = sqlite3.connect(self._folder / DATABASE, isolation_level=None)
            self._prepare()
        except sqlite3.Error as error:
            self._lock.close()
            raise SweepError(f"{self._folder / DATABASE}: cannot be used: {error}") from error
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
                rows = [(outcome.index, outcome.error, *self._packed(outcome)) for outcome in outcomes]
                self._database.executemany("INSERT OR REPLACE INTO runs VALUES (?, ?, ?, ?)", rows)
        except sqlite3.Error as error:
            self._layouts.clear()
            raise SweepStoppedError(f"{self._folder / DATABASE}: cannot be written: {error}") from error

    def kept(self, size: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Which of so many points have finished, and which of these failed."""
        finished, failed = np.zeros(size, bool), np.zeros(size, bool)
        for point, wrong in self._database.execute("SELECT point, error IS NOT NULL FROM runs"):
            finished[point], failed[point] = True, wrong
        return finished, failed

    def outcomes(self, first: int, last: int) -> Iterator[Outcome]:
        """Outcomes of the points from a first up to, not including, a last, in order."""
        layouts = {key: json.loads(text) for key, text in self._database.execute("SELECT id, text FROM layouts")}
        query = "SELECT point, error, layout, numbers FROM runs WHERE point >= ? AND point < ? ORDER BY point"
        for point, error, layout, numbers in self._database.execute(query, (first, last)):
            yield Outcome(point, error, {} if layout is None else _unpacked(layouts[layout], numbers))

    def shapes(self) -> dict[str, tuple[int, ...]]:
        """For each name of a value the largest shape of any run."""
        largest: dict[str, tuple[int, ...]] = {}
        for (text,) in self._database.execute("SELECT text FROM layouts WHERE id IN (SELECT layout FROM runs)"):
            for name, shape in json.loads(text):
                sizes = zip(shape, largest.get(name, shape), strict=True)
                largest[name] = tuple(max(pair) for pair in sizes)
        return largest

    def failures(self) -> Iterator[tuple[int, str]]:
        """Numbers of the failed points with their errors, in order."""
        yield from self._database.execute("SELECT point, error FROM runs WHERE error IS NOT NULL ORDER BY point")

    def _prepare(self) -> None:
        # A rollback journal, not a write-ahead log, which network file systems do not have.
        self._database.execute("PRAGMA journal_mode = DELETE")
        self._database.execute("PRAGMA synchronous = EXTRA")
        with self._transaction():
            for statement in filter(str.strip, _TABLES.split(";")):
                self._database.execute(statement)
            known = dict(self._database.execute("SELECT key, value FROM meta"))
            if not known:
                self._database.executemany("INSERT INTO meta VALUES (?, ?)", self._identity.items())
        if known and (different := [key for key, value in self._identity.items() if known.get(key) != value]):
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

    def _packed(self, outcome: Outcome) -> tuple[int | None, bytes | None]:
        """Layout and numbers of an outcome: which values it has is said once for all runs that have the same."""
        if outcome.error is not None:
            return None, None
        text = json.dumps([[name, list(np.shape(value))] for name, value in outcome.values.items()])
        if text not in self._layouts:
            self._database.execute("INSERT OR IGNORE INTO layouts (text) VALUES (?)", (text,))
            (self._layouts[text],) = self._database.execute("SELECT id FROM layouts WHERE text = ?", (text,)).fetchone()
        numbers = np.concatenate([np.zeros(0), *(np.ravel(value) for value in outcome.values.values())])
        data = numbers.astype("<f8").tobytes()
        return self._layouts[text], zlib.compress(data, 1) if len(numbers) > _COMPRESSED else data


def _unpacked(layout: list[tuple[str, list[int]]], data: bytes) -> dict[str, NDArray[np.float64]]:
    count = sum(int(np.prod(shape)) for _, shape in layout)
    numbers = np.frombuffer(zlib.decompress(data) if count > _COMPRESSED else data, "<f8")
    ends = np.cumsum([int(np.prod(shape)) for _, shape in layout])
    return {
        name: numbers[end - int(np.prod(shape)) : end].reshape(shape)
        for (name, shape), end in zip(layout, ends, strict=True)
    }


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
        raise SweepError(f"{path.parent}: another process is sweeping into this folder; wait for it") from error
    return file


def _difference(different: Sequence[str], known: dict[str, str], wanted: dict[str, str]) -> str:
    if "sweep" in different:
        return "the runs of another sweep (base scenario, values or sampling differ); give another folder"
    changes = ", ".join(f"{key} {known.get(key)}, now {wanted[key]}" for key in different)
    return f"runs made otherwise ({changes}), which would differ; give another folder"
