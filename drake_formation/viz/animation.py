"""A result as a film in the plane: for a notebook, or as an MP4 or a GIF."""

import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import animation, rc_context

from drake_formation.viz.errors import FilmError
from drake_formation.viz.film_picture import FilmPicture
from drake_formation.viz.playback import Playback
from drake_formation.viz.style import own_style

if TYPE_CHECKING:
    import xarray as xr

RATE = 20
"""Pictures a second."""

DPI = 100

NOTEBOOK_MEGABYTES = 50
"""What a film in a notebook may take where there is no ffmpeg."""


def animate(result: "xr.Dataset", *, seconds: float = 10.0, follow: bool = False) -> "Animation":
    """A film of a result: robots and where they have been, springs in the colour of their strain, obstacles, channels.

    Each picture has the packets that are under way at its moment, and what has broken or failed until then.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        seconds: how long the film is, however long the run was.
        follow: keep the formation in the middle of the picture; otherwise all of the way is seen.

    Returns:
        A film that a notebook shows by itself, and that :meth:`Animation.save` writes to a file.

    Raises:
        ValueError, ScenarioError: it is not a result of this version, or the film would have no length.
    """
    return Animation(result, seconds, follow=follow)


class Animation:
    """A film of a result; see :func:`animate`.

    Attributes:
        times: of its pictures (s), shape (pictures,).
        figure: in which each is drawn, in its turn.
    """

    def __init__(self, result: "xr.Dataset", seconds: float, *, follow: bool = False) -> None:
        if not seconds > 0:
            raise ValueError(f"a film of {seconds:g} s has no length")
        playback = Playback(result)
        self.times = np.linspace(playback.begin, playback.end, max(round(seconds * RATE), 1) + 1)
        with own_style():
            self._picture = FilmPicture(result, playback, self.times, follow=follow)
        self.figure = self._picture.figure

    def save(self, path: str | Path) -> None:
        """Write the film to a file.

        Args:
            path: ends in .mp4 or .gif.

        Raises:
            FilmError: it ends in something else, or it is an .mp4 and there is no ffmpeg, or ffmpeg failed.
            OSError: it cannot be written.
        """
        require_film(Path(path))
        suffix = Path(path).suffix.lower()
        with own_style(), rc_context({"animation.ffmpeg_path": ffmpeg() or "ffmpeg"}):
            try:
                self.film().save(path, writer=_WRITERS[suffix](), dpi=DPI)
            except subprocess.CalledProcessError as error:
                raise FilmError(f"{path}: ffmpeg failed with status {error.returncode}") from error

    def film(self) -> animation.FuncAnimation:
        """The film as Matplotlib's own; only one of a figure at a time."""
        return animation.FuncAnimation(
            self.figure, self._picture.show, len(self.times), interval=1000 / RATE, blit=False
        )

    def _repr_html_(self) -> str:
        """As HTML5 video where there is an ffmpeg, else as pictures that JavaScript plays."""
        program = ffmpeg()
        with (
            own_style(),
            rc_context({"animation.embed_limit": NOTEBOOK_MEGABYTES, "savefig.dpi": DPI}),
            rc_context({"animation.ffmpeg_path": program} if program else {}),
        ):
            film = self.film()
            return film.to_html5_video() if program else film.to_jshtml(fps=RATE, default_mode="once")


def require_film(path: Path) -> None:
    """See to it that a film can be written to a file of this name.

    Raises:
        FilmError: its suffix is none of a film's, or it is an .mp4 and there is no ffmpeg.
    """
    if path.suffix.lower() not in _WRITERS:
        raise FilmError(f"cannot write {path.name} as a film: the name must end in {' or '.join(_WRITERS)}")
    if path.suffix.lower() == ".mp4" and ffmpeg() is None:
        raise FilmError(
            f"{path.name} needs ffmpeg, which is not there: pip install 'drake-formation[video]' brings it, "
            "and a .gif does without"
        )


def ffmpeg() -> str | None:
    """The program, as on PATH or else as ``imageio-ffmpeg`` brings it; None where neither is."""
    if program := shutil.which("ffmpeg"):
        return program
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        found: str = get_ffmpeg_exe()
    except (ImportError, RuntimeError):  # a wheel without the program for this machine says RuntimeError
        return None
    return found


_WRITERS: dict[str, Callable[[], animation.AbstractMovieWriter]] = {
    ".mp4": lambda: animation.FFMpegWriter(fps=RATE, bitrate=-1),
    ".gif": lambda: animation.PillowWriter(fps=RATE),
}
