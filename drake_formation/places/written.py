"""What a command says of the files that it has written."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from drake_formation.places.place import Place

PICTURES = "figures"
"""Folder of a result's pictures, inside its own."""


@dataclass(frozen=True)
class Written:
    """What was written.

    Attributes:
        folder: where.
        failed: pictures that are missing, by name, and why.
        notes: why it is somewhere else than asked for, if it is.
    """

    folder: Path
    failed: dict[str, str]
    notes: list[str]

    def remarks(self) -> list[str]:
        """What the user should know, line by line."""
        pictures = [f"No figure {name}: {reason.removesuffix('.')}." for name, reason in self.failed.items()]
        return [*pictures, *self.notes]


def written(place: Place, write: Callable[[Path], dict[str, str]], take: Callable[[], Path] | None = None) -> Written:
    """Fill a place and take it.

    Args:
        place: where.
        write: writes the files to a folder; gives the pictures that failed, and why.
        take: takes the place, if not as usual.
    """
    failed = place.fill(write)
    folder = (take or place.take)()
    return Written(folder, failed, place.notes)
