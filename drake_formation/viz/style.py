"""Figures in this project's own style, whatever a user's matplotlibrc says, and none of them worth a result."""

import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150


@contextmanager
def own_style() -> Iterator[None]:
    """Matplotlib's defaults, on which all figures here are built: a user's fonts, sizes or LaTeX do not reach them."""
    from matplotlib import style

    with style.context("default"), warnings.catch_warnings():
        # A name in letters that the font lacks is drawn with boxes.
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield


def draw_each(figures: "Mapping[str, Callable[[], Figure]]", folder: Path) -> dict[str, str]:
    """Draw figures to PNG files, each of which may fail for itself.

    Args:
        figures: what makes each, by the name of its file.
        folder: where; it exists.

    Returns:
        Figures that could not be drawn, by name, and why.
    """
    return attempt_each({name: partial(draw, make, folder / f"{name}.png") for name, make in figures.items()})


def draw(make: "Callable[[], Figure]", path: Path, dpi: float = DPI) -> None:
    """Draw a figure to a file, which is complete or not there.

    Args:
        make: what makes the figure.
        path: where; its suffix is the format.
        dpi: pixels an inch.
    """
    with own_style():
        try:
            make().savefig(path, dpi=dpi)
        except BaseException:
            path.unlink(missing_ok=True)
            raise


def attempt_each(pictures: Mapping[str, Callable[[], object]]) -> dict[str, str]:
    """Make pictures, each of which may fail for itself: a result is worth more.

    Args:
        pictures: what makes each, by name.

    Returns:
        Pictures that failed, by name, and why.
    """
    failed = {}
    for name, make in pictures.items():
        try:
            make()
        except Exception as error:
            failed[name] = str(error).partition("\n")[0] or type(error).__name__
    return failed
