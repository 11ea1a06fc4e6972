"""Names and moves of a result's files: into place as a whole, or not at all."""

import errno
import fcntl
import os
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

HIDDEN = ".drake-formation-"
"""How names of folders begin that hold what is not in its place yet."""
LONGEST_NAME = 255


@dataclass(frozen=True)
class Kind:
    """A sort of result.

    Attributes:
        mark: the file by which an earlier result of this sort, which may be replaced, is known.
        names: everything that such a result consists of, the mark included; other files beside them stay.
    """

    mark: str
    names: tuple[str, ...]


def hidden() -> str:
    """A name for what is not in its place yet."""
    return HIDDEN + secrets.token_hex(6)


def fitting(name: str, ending: str) -> str:
    """A name with an ending, cut where together they are longer than a file system allows."""
    while len(os.fsencode(name + ending)) > LONGEST_NAME:
        name = name[:-1]
    return name + ending


def stamps(folder: Path, kind: Kind) -> dict[str, tuple[int, int]]:
    """What tells whether an earlier result in a folder is still the same."""
    states = {name: (folder / name).lstat() for name in kind.names if os.path.lexists(folder / name)}
    return {name: (state.st_ino, state.st_mtime_ns) for name, state in states.items()}


def renamed(source: Path, target: Path) -> bool:
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


def replaced(source: Path, folder: Path, kind: Kind, expected: dict[str, tuple[int, int]] | None = None) -> bool:
    """Move a result's files into a folder, in the place of an earlier one's; whether these were as expected."""
    former = folder.absolute() / hidden()
    with alone(folder):
        if expected is not None and stamps(folder, kind) != expected:
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
def alone(folder: Path) -> Iterator[None]:
    """Keep other processes of this package from moving files in a folder meanwhile."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with suppress(OSError):  # some network file systems know no locks
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)
