"""Places for results: checked and reserved before anything is computed, taken when a result is complete.

Files are written to a hidden folder beside the place wanted, or inside it where that exists already, and moved to their
names at the end. So a result is there whole or not at all, and a place that cannot be used is known before the work.
"""

import errno
import fcntl
import itertools
import os
import secrets
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

T = TypeVar("T")

_HIDDEN = ".drake-formation-"
_LONGEST_NAME = 255
_ROOM = 65536
"""Bytes that the disk must still take before work is begun."""


class OutputError(OSError):
    """A place where a result cannot be written."""


@dataclass(frozen=True)
class Kind:
    """A sort of result.

    Attributes:
        mark: the file by which an earlier result of this sort, which may be replaced, is known.
        names: everything that such a result consists of, the mark included; other files beside them stay.
    """

    mark: str
    names: tuple[str, ...]


class Place:
    """A place that is reserved; from :func:`reserved`.

    Args:
        folder: where the result is to go.
        kind: of the result.

    Attributes:
        folder: where the result is to go.
        notes: what the user should know if it goes elsewhere.
    """

    def __init__(self, folder: Path, kind: Kind) -> None:
        self.folder = folder
        self.notes: list[str] = []
        self._kind = kind
        self._existed = folder.is_dir()
        self._found = _stamps(folder, kind)
        self._staging = (folder if self._existed else folder.parent).absolute() / _hidden()
        self._staging.mkdir()
        self._kept = False

    def fill(self, write: Callable[[Path], T]) -> T:
        """Have the files written to a folder that is not in its place yet.

        If they cannot be written there any more (the disk is full, the folder was removed), they go to the system's
        temporary folder: a result is not thrown away.

        Args:
            write: writes them to the folder it is given.

        Returns:
            What ``write`` returns.

        Raises:
            OutputError: they can be written neither here nor there.
        """
        try:
            self._staging.mkdir(parents=True, exist_ok=True)
            return write(self._staging)
        except OSError as error:
            self.notes.append(f"{self.folder}: cannot be written: {reason(error)}.")
        self.discard()
        try:
            self._staging, self._kept = Path(tempfile.mkdtemp(prefix="drake-formation-")), True
            return write(self._staging)
        except OSError as error:
            raise OutputError(f"{self.notes[-1]} Nor can {self._staging}: {reason(error)}.") from error

    def take(self) -> Path:
        """Move the files to the place, or beside it if it has been taken meanwhile; gives where they are."""
        if self._kept:
            return self._staging
        with suppress(OSError):
            if not self._existed and _renamed(self._staging, self.folder):
                return self.folder
            if self._existed and _replaced(self._staging, self.folder, self._kind, self._found):
                return self.folder
        self.notes.append(f"{self.folder} has been taken meanwhile.")
        return self._beside(f"-{number}" for number in itertools.count(2))

    def take_beside(self, suffix: str, kind: Kind) -> Path:
        """Move the files beside the place, where its own content stays as it is.

        Args:
            suffix: added to the place's name; a number follows if that name holds something else.
            kind: what may be replaced there.

        Returns:
            Where the files are.
        """
        if self._kept:
            return self._staging
        numbered = (f"{suffix}-{number}" for number in itertools.count(2))
        return self._beside(itertools.chain([suffix], numbered), kind)

    def discard(self) -> None:
        """Remove files that were not taken."""
        if not self._kept:
            shutil.rmtree(self._staging, ignore_errors=True)

    def _beside(self, endings: Iterable[str], kind: Kind | None = None) -> Path:
        whole = self.folder if self.folder.name not in ("", "..") else self.folder.resolve()
        candidates = [whole.parent, whole] if self._existed else [whole.parent]
        for parent in candidates:  # beside a folder nothing may be writable where inside it something is
            with suppress(OSError):
                for ending in endings:
                    target = parent / _fitting(whole.name, ending)
                    if _renamed(self._staging, target):
                        return target
                    if kind and (target / kind.mark).is_file() and _replaced(self._staging, target, kind):
                        return target
                    self.notes.append(f"{target} holds something else.")
        self._kept = True
        return self._staging


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
            with _alone(folder.parent):
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
    partial = path.parent / f"{_hidden()}{path.suffix}"
    with explained(path):
        _require_nameable(path)
        if path.is_dir():
            raise OutputError(f"{path}: is a folder; give the name of a file")
        with _alone(path.parent):
            if not path.exists():  # as above
                path.touch(exist_ok=False)
                path.unlink()
        partial.touch()
    try:
        yield partial
        with explained(path), _alone(path.parent):
            partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


@contextmanager
def explained(path: Path) -> Iterator[None]:
    """What the system says against a path, as an OutputError that names it."""
    try:
        yield
    except OutputError:
        raise
    except (OSError, ValueError) as error:
        raise OutputError(f"{path}: cannot be written: {reason(error)}") from error


def reason(error: OSError | ValueError) -> str:
    """Why the system refuses, in its own words without numbers and paths."""
    return (isinstance(error, OSError) and error.strerror) or str(error)


def _require_free(folder: Path, kind: Kind) -> None:
    _require_nameable(folder)
    if folder.is_symlink() and not folder.exists():
        raise OutputError(f"{folder}: is a link that leads nowhere; give another folder")
    if folder.exists() and not folder.is_dir():
        raise OutputError(f"{folder}: is a file; give a folder that is new, empty or holds an earlier {kind.mark}")
    if not folder.is_dir() or (folder / kind.mark).exists():
        return
    if any(not entry.name.startswith(_HIDDEN) for entry in folder.iterdir()):
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


def _hidden() -> str:
    return _HIDDEN + secrets.token_hex(6)


def _fitting(name: str, ending: str) -> str:
    """A name with an ending, cut where together they are longer than a file system allows."""
    while len(os.fsencode(name + ending)) > _LONGEST_NAME:
        name = name[:-1]
    return name + ending


def _stamps(folder: Path, kind: Kind) -> dict[str, tuple[int, int]]:
    """What tells whether an earlier result in a folder is still the same."""
    states = {name: (folder / name).lstat() for name in kind.names if os.path.lexists(folder / name)}
    return {name: (state.st_ino, state.st_mtime_ns) for name, state in states.items()}


def _renamed(source: Path, target: Path) -> bool:
    """Give a folder a name that is free, or an empty folder's; whether it was.

    Raises:
        OSError: that name will not do.
    """
    try:
        source.rename(target)
    except OSError as error:
        if error.errno in (errno.ENOTEMPTY, errno.EEXIST, errno.ENOTDIR) and os.path.lexists(target):
            return False
        if error.errno != errno.EXDEV or os.path.lexists(target):
            raise
        shutil.copytree(source, target)
        shutil.rmtree(source, ignore_errors=True)
    return True


def _replaced(source: Path, folder: Path, kind: Kind, expected: dict[str, tuple[int, int]] | None = None) -> bool:
    """Move a result's files into a folder, in the place of an earlier one's; whether these were as expected."""
    former = folder.absolute() / _hidden()
    with _alone(folder):
        if expected is not None and _stamps(folder, kind) != expected:
            return False
        former.mkdir()
        moves = [(folder / name, former / name) for name in kind.names if os.path.lexists(folder / name)]
        moves += [(source / name, folder / name) for name in kind.names if os.path.lexists(source / name)]
        done = []
        try:
            for old, new in moves:
                old.rename(new)
                done.append((old, new))
        except BaseException:
            for old, new in reversed(done):
                new.rename(old)
            former.rmdir()
            raise
    shutil.rmtree(former, ignore_errors=True)
    shutil.rmtree(source, ignore_errors=True)
    return True


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Keep other processes of this package from moving files in a folder meanwhile."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):  # some network file systems know no locks
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)
