"""Places where a result cannot be written."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


class OutputError(OSError):
    """A place where a result cannot be written."""


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
