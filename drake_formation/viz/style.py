"""Figures in this project's own style, whatever a user's matplotlibrc says, and none of them worth a result."""

import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Drawn: TypeAlias = "Figure | Axes | list[Axes]"
"""What a figure function gives: a figure, or axes of one."""

SHEET = "drake_formation.viz.paper"
"""The style sheet, as ``matplotlib.pyplot.style.use`` takes it."""

FORMATS = ("png", "pdf", "svg")
"""Of a figure's file."""

DATES: dict[str, dict[str, None]] = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}
"""What of a file tells when it was written: the same figure gives the same file."""


@contextmanager
def own_style() -> Iterator[None]:
    """This project's style sheet on Matplotlib's defaults: a user's fonts, sizes or LaTeX do not reach its figures."""
    from matplotlib import style

    with style.context(["default", SHEET]), warnings.catch_warnings():
        # A name in letters that the font lacks is drawn with boxes.
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield


def draw_each(figures: Mapping[str, Callable[[], Drawn]], folder: Path, file_format: str = "png") -> dict[str, str]:
    """Draw figures to files, each of which may fail for itself.

    Args:
        figures: what makes each, by the name of its file.
        folder: where; it exists.
        file_format: of the files, one of ``FORMATS``.

    Returns:
        Figures that could not be drawn, by name, and why.

    Raises:
        ValueError: there is no such format.
    """
    if file_format not in FORMATS:
        raise ValueError(f"no format {file_format!r} of figures; there are {', '.join(FORMATS)}")
    paths = {name: folder / f"{name}.{file_format}" for name in figures}
    return attempt_each({name: partial(draw, make, paths[name]) for name, make in figures.items()})


def draw(make: Callable[[], Drawn], path: Path) -> None:
    """Draw a figure to a file, which is complete or not there.

    Args:
        make: what makes the figure.
        path: where; its suffix is the format.
    """
    with own_style():
        try:
            figure_of(make()).savefig(path, metadata=DATES.get(path.suffix[1:]))
        except BaseException:
            path.unlink(missing_ok=True)
            raise


def figure_of(drawn: Drawn) -> "Figure":
    """The whole figure of what a figure function gives."""
    from matplotlib.figure import Figure

    if isinstance(drawn, list):
        return figure_of(drawn[0])
    whole = drawn if isinstance(drawn, Figure) else drawn.get_figure()
    assert isinstance(whole, Figure)  # no figure of this project has subfigures
    return whole


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
