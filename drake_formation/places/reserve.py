"""Places are checked and reserved before anything is computed, so that one that cannot be used is known in time."""

import errno
import itertools
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from drake_formation.places.errors import OutputError, explained
from drake_formation.places.moves import HIDDEN, Kind, alone, hidden
from drake_formation.places.place import Place

_ROOM = 65536
"""Bytes that the disk must still take before work is begun."""


@contextmanager
def reserved(folder: Path, kind: Kind) -> Iterator[Place]:
    """Reserve a place for a result; if it is not taken in the end, nothing remains of it.

    Args:
        folder: new, empty, or with an earlier result of the kind.
        kind: of the result.

    Raises:
        OutputError: it cannot be used, or holds something else, which would be lost.
    """
    made: list[Path] = []
    place = None
    try:
        with explained(folder):
            _require_free(folder, kind)
            _make(folder.parent, made)
            with alone(folder.parent):
                if not folder.is_dir():  # whether a name will do is known when it has been used
                    folder.mkdir()
                    folder.rmdir()
                place = Place(folder, kind)
            place.fill(_probe)
            if place.notes:
                raise OutputError(place.notes[0].removesuffix("."))
        yield place
    finally:
        if place:
            place.discard()
        _remove(made)


def make_folder(folder: Path, kind: Kind) -> None:
    """Make a folder in which a result grows, such as a sweep's; where that fails, nothing remains of it.

    Args:
        folder: new, empty, or with an earlier part of the result.
        kind: of the result.

    Raises:
        OutputError: it cannot be used, or holds something else.
    """
    made: list[Path] = []
    try:
        with explained(folder):
            _require_free(folder, kind)
            _make(folder, made)
            Place(folder, kind).discard()
    except BaseException:
        _remove(made)
        raise


@contextmanager
def reserved_file(path: Path) -> Iterator[Path]:
    """Reserve a place for a file, which replaces what is there if all goes well.

    Args:
        path: where.

    Yields:
        The file to write; its suffix is the same.

    Raises:
        OutputError: it cannot be written there.
    """
    partial = path.parent / f"{hidden()}{path.suffix}"
    with explained(path):
        _require_nameable(path)
        if path.is_dir():
            raise OutputError(f"{path}: is a folder; give the name of a file")
        with alone(path.parent):
            if not path.exists():  # as above
                path.touch(exist_ok=False)
                path.unlink()
        partial.touch()
    try:
        yield partial
        with explained(path), alone(path.parent):
            partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def _require_free(folder: Path, kind: Kind) -> None:
    _require_nameable(folder)
    if folder.is_symlink() and not folder.exists():
        raise OutputError(f"{folder}: is a link that leads nowhere; give another folder")
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder}: is a file; give a folder that is new, empty or holds an earlier {kind.mark}")
    if not folder.is_dir() or (folder / kind.mark).exists():
        return
    if any(not entry.name.startswith(HIDDEN) for entry in folder.iterdir()):
        raise OutputError(
            f"{folder}: holds something else than a {kind.mark}, which would be lost; give another folder"
        )


def _require_nameable(path: Path) -> None:
    """The NetCDF library wants text for a name, as the locale would write it."""
    try:
        str(path.absolute()).encode(sys.getfilesystemencoding())
    except UnicodeEncodeError as error:
        problem = f"its name is not text in the locale's encoding, {error.encoding}; LC_ALL=C.UTF-8 may help"
        raise OutputError(f"{path}: cannot be written: {problem}") from error


def _make(folder: Path, made: list[Path]) -> None:
    """Make a folder and those around it; those that were made are noted as they are."""
    missing = list(itertools.takewhile(lambda path: not path.is_dir(), [folder, *folder.parents]))
    for path in reversed(missing):
        if path.exists():
            raise NotADirectoryError(errno.ENOTDIR, f"{path} is a file")
        path.mkdir(exist_ok=True)
        made.append(path)


def _remove(made: list[Path]) -> None:
    """Remove folders that were made, as far as they are empty."""
    for folder in reversed(made):
        with suppress(OSError):
            folder.rmdir()


def _probe(folder: Path) -> None:
    file = folder / "probe"
    file.write_bytes(bytes(_ROOM))
    file.unlink()
