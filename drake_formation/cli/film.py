"""A film beside what a command writes, if one is wanted."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr


@contextmanager
def filming(path: Path | None) -> Iterator[Callable[["xr.Dataset"], None]]:
    """A place for a film, checked and reserved before anything runs.

    Args:
        path: of the film; None for none.

    Yields:
        What writes the film of a result, if one is wanted.

    Raises:
        ValueError: a film cannot be written to a file of this name, or there is no ffmpeg.
        OutputError: it cannot be written there.
    """
    if path is None:
        yield lambda _: None
        return
    from drake_formation.places import reserved_file
    from drake_formation.viz.animation import animate, require_film

    require_film(path)
    with reserved_file(path) as reel:
        yield lambda result: animate(result).save(reel)
