"""A place for a result: its files are written to a hidden folder, and taken to their names when they are complete."""

import itertools
import shutil
import tempfile
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

from drake_formation.places.errors import OutputError, reason
from drake_formation.places.moves import Kind, fitting, hidden, renamed, replaced, stamps

T = TypeVar("T")


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
        self._found = stamps(folder, kind)
        self._staging = (folder if self._existed else folder.parent).absolute() / hidden()
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
            if not self._existed and renamed(self._staging, self.folder):
                return self.folder
            if self._existed and replaced(self._staging, self.folder, self._kind, self._found):
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
                    target = parent / fitting(whole.name, ending)
                    if renamed(self._staging, target):
                        return target
                    if kind and (target / kind.mark).is_file() and replaced(self._staging, target, kind):
                        return target
                    self.notes.append(f"{target} holds something else.")
        self._kept = True
        return self._staging
