"""Axes to draw into, a user's or new ones as wide as a journal's columns, and what is written about them."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import BytesIO
from typing import Any, Literal

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drake_formation.viz.style import Drawn, figure_of, own_style

Width = Literal["column", "page"]

WIDTHS: dict[Width, float] = {"column": 88.0, "page": 180.0}
"""Of figures (mm): within one column of IEEE (88.9), Nature (89) and Elsevier (90), and within both of theirs."""
INCH = 25.4
"""In millimetres."""
HEIGHTS: dict[Width, float] = {"column": 60.0, "page": 80.0}
"""Of axes that stand alone (mm)."""
ROWS: dict[Width, float] = {"column": 36.0, "page": 43.0}
"""Of axes below each other (mm)."""
TITLE, LINE = 7.0, 4.2
"""Heights of a figure's title and of a line in a legend (mm)."""
NOTEBOOK_DPI = 120
NARROW = 120.0
"""Figures less wide (mm) have nothing beside their axes."""


class Panel(Axes):
    """Axes that a notebook shows: as the figure that they are in."""

    def _repr_png_(self) -> bytes:
        return _png(self)


class Panels(list[Axes]):
    """Several axes of one figure, which a notebook shows."""

    def _repr_png_(self) -> bytes:
        return _png(self)


def _png(drawn: Drawn) -> bytes:
    file = BytesIO()
    with own_style():
        figure_of(drawn).savefig(file, format="png", dpi=NOTEBOOK_DPI)
    return file.getvalue()


def height(width: Width, *, alone: bool = True) -> float:
    """How high (mm) axes are in a figure, alone or below each other.

    Raises:
        ValueError: there is no such width.
    """
    if width not in WIDTHS:
        raise ValueError(f"a figure is as wide as a {' or a '.join(WIDTHS)}, not {width!r}")
    return (HEIGHTS if alone else ROWS)[width]


@contextmanager
def drawing(
    given: Axes | Sequence[Axes] | None,
    heights: Sequence[float],
    width: Width = "page",
    *,
    title: str = "",
    columns: int = 1,
    **settings: Any,
) -> Iterator[Panels]:
    """Axes to draw into: those that are given, else those of a new figure in this project's style.

    Args:
        given: as many as there are rows and columns, or None.
        heights: of the rows (mm), labels included.
        width: of the figure.
        title: of the figure; the caption of one in a column, and axes that are given, have their own.
        columns: in each row.
        **settings: more for ``Figure.subplots``.

    Raises:
        ValueError: more or fewer are given than there is to draw.
    """
    if given is not None:
        panels = Panels([given] if isinstance(given, Axes) else np.ravel(np.asarray(given, dtype=object)))
        if len(panels) != len(heights) * columns:
            raise ValueError(f"{len(heights) * columns} axes are drawn into, and {len(panels)} were given")
        yield panels
        return
    with own_style():
        figure = Figure(layout="constrained")
        if width == "page" and title:
            figure.suptitle(title)
        kind = {"axes_class": Panel}
        panels = Panels(np.ravel(figure.subplots(len(heights), columns, squeeze=False, subplot_kw=kind, **settings)))
        resize(panels, heights, width)
        yield panels


def resize(panels: Sequence[Axes], heights: Sequence[float], width: Width) -> None:
    """Give a figure its size (mm): the rows of its axes theirs, and a line to its title."""
    figure, grid = panels[0].get_figure(), panels[0].get_gridspec()
    assert isinstance(figure, Figure)
    assert grid is not None
    grid.set_height_ratios(list(heights))
    title = TITLE if figure.get_suptitle() else 0.0
    figure.set_size_inches(WIDTHS[width] / INCH, (sum(heights) + title) / INCH)


def legend(axes: Axes, entries: Sequence[Artist] | None = None, *, heading: str = "", above: bool = False) -> float:
    """Say what is what beside the axes or, as in a narrow figure always, above them; never on what is drawn.

    Args:
        axes: whose.
        entries: what is in it; what has a label on the axes if not given.
        heading: of the legend.
        above: where there is room beside the axes, too.

    Returns:
        The height that it takes above the axes (mm).
    """
    handles = axes.get_legend_handles_labels()[0] if entries is None else list(entries)
    labels = [str(handle.get_label()) for handle in handles]
    if not labels:
        return 0.0
    width = _width(axes)
    if not above and not is_narrow(axes):
        axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.0, 1.0), title=heading)
        return 0.0
    columns = _columns(labels, width)
    # To the left of the axes there is room above their label.
    place: dict[str, Any] = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0), "borderaxespad": 0.2}
    axes.legend(handles=handles, title=heading, ncols=columns, handlelength=2.0, columnspacing=1.2, **place)
    return LINE * -(-len(labels) // columns)


def is_narrow(axes: Axes) -> bool:
    """Whether there is no room beside axes for what belongs to them."""
    return _width(axes) < NARROW


def _width(axes: Axes) -> float:
    """Of the figure (mm)."""
    return float(axes.figure.bbox.width / axes.figure.dpi * INCH)


def _columns(labels: Sequence[str], width: float) -> int:
    """How many entries of a legend there is room for beside each other (mm)."""
    handle, letter = 10.0, 1.3
    return max(1, int(width / (handle + letter * max(map(len, labels)))))
