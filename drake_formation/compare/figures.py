"""Figures of a comparison: paths and errors laid over each other, one look a law, and error against effort."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from drake_formation.compare.comparison import Comparison
from drake_formation.compare.run import Outcome
from drake_formation.compare.table import Row
from drake_formation.viz.figures.histories import draw_lines, largest
from drake_formation.viz.figures.looks import Look, looks_of
from drake_formation.viz.figures.panels import LINE, TITLE, Width, drawing, height, resize
from drake_formation.viz.figures.plane import lay_over, plane_height
from drake_formation.viz.figures.quantities import CONSENSUS_ERROR
from drake_formation.viz.style import Drawn, draw_each, figure_of

ERROR, EFFORT = "consensus_error_m", "rms_force_n"
"""The metrics of the Pareto plot."""
DECADE = 10.0
"""Axes whose values differ by more are logarithmic."""


def write_comparison_figures(
    comparison: Comparison, outcomes: Sequence[Outcome], table: Sequence[Row], folder: Path, file_format: str = "png"
) -> dict[str, str]:
    """Draw all figures as files in a folder that exists; gives those that failed, and why."""
    drawn: dict[str, Callable[[], Drawn]] = {
        "paths": partial(paths, comparison, outcomes),
        "consensus_error": partial(consensus_error, comparison, outcomes),
        "error_against_effort": partial(error_against_effort, comparison, table),
    }
    return draw_each(drawn, folder, file_format)


def paths(
    comparison: Comparison,
    outcomes: Sequence[Outcome],
    axes: Axes | Sequence[Axes] | None = None,
    *,
    width: Width = "page",
) -> list[Axes]:
    """Where the robots go while they carry the object, the first run of every law; a panel a case.

    Args:
        comparison: what was compared.
        outcomes: of its runs.
        axes: where to draw, one a case; a figure of their own if not given.
        width: of that figure.
    """
    with _panels(comparison, axes, width) as panels:
        for panel, own in _by_case(comparison, outcomes, panels):
            firsts = {outcome.run.law: outcome.result for outcome in reversed(own)}
            lay_over(panel, {law: firsts[law] for law in comparison.laws})
        for panel in panels[:-1]:
            panel.set_xlabel("")
        if axes is None:
            for panel in panels:
                panel.autoscale_view()
            resize(panels, [plane_height(panel, width) + TITLE + 2 * LINE for panel in panels], width)
    return panels


def consensus_error(
    comparison: Comparison,
    outcomes: Sequence[Outcome],
    axes: Axes | Sequence[Axes] | None = None,
    *,
    width: Width = "page",
) -> list[Axes]:
    """The largest consensus error of any robot over time (paper, Eq. 19), all runs of every law; a panel a case.

    Arguments are as for :func:`paths`.
    """
    looks = law_looks(comparison)
    with _panels(comparison, axes, width) as panels:
        for panel, own in _by_case(comparison, outcomes, panels):
            lines = [largest(CONSENSUS_ERROR, outcome.result, looks[outcome.run.law], None) for outcome in own]
            draw_lines(panel, lines)
            panel.set_ylabel(CONSENSUS_ERROR.largest_label)
        for panel in panels[:-1]:
            panel.set_xlabel("")
    return panels


def error_against_effort(
    comparison: Comparison, table: Sequence[Row], axes: Axes | Sequence[Axes] | None = None, *, width: Width = "page"
) -> list[Axes]:
    """Largest consensus error against RMS force, means over the runs; a line joins laws that none beats in both.

    Arguments are as for :func:`paths`.
    """
    looks = law_looks(comparison)
    with _panels(comparison, axes, width) as panels:
        for panel, case in zip(panels, comparison.cases, strict=True):
            _draw_front(panel, [row for row in table if row.case == case], looks)
        panels[-1].set_xlabel("RMS control force (N)")
    return panels


def law_looks(comparison: Comparison) -> dict[str, Look]:
    """The look of each law, the same in every figure."""
    return looks_of(comparison.laws)


def _draw_front(axes: Axes, rows: Sequence[Row], looks: dict[str, Look]) -> None:
    points = []
    for row in rows:
        error, effort, its = row.cells[ERROR], row.cells[EFFORT], looks[row.law]
        if np.isfinite([error.mean, effort.mean]).all():
            points.append((effort.mean, error.mean))
            axes.errorbar(
                effort.mean, error.mean, xerr=effort.spread or None, yerr=error.spread or None,
                fmt=its.marker, color=its.colour, markersize=6,
            )  # fmt: skip
    front = sorted(point for point in points if not any(_beats(other, point) for other in points))
    if front:
        axes.plot(*zip(*front, strict=True), color="0.6", linewidth=1.0, zorder=0)
    axes.set(ylabel="largest consensus error\n$\\|e_i\\|$ (m)")
    if points:
        for letter, values in zip("xy", np.transpose(points), strict=True):
            if values.max() > DECADE * values.min() > 0:
                axes.set(**{f"{letter}scale": "log"})


def _beats(one: tuple[float, float], other: tuple[float, float]) -> bool:
    return one != other and one[0] <= other[0] and one[1] <= other[1]


@contextmanager
def _panels(comparison: Comparison, given: Axes | Sequence[Axes] | None, width: Width) -> Iterator[list[Axes]]:
    """A panel a case, one above the other, and what the laws look like below them all."""
    title = comparison.description or comparison.name
    with drawing(given, [height(width)] * len(comparison.cases), width, title=title) as panels:
        yield panels
        if len(panels) > 1:
            for panel, case in zip(panels, comparison.cases, strict=True):
                panel.set_title(case)
        entries = [
            Line2D([], [], color=its.colour, linestyle=its.dashes, marker=its.marker, label=law)
            for law, its in law_looks(comparison).items()
        ]
        if given is None:
            figure_of(panels).legend(handles=entries, loc="outside lower center", ncols=4 if width == "page" else 2)


def _by_case(
    comparison: Comparison, outcomes: Sequence[Outcome], panels: Sequence[Axes]
) -> list[tuple[Axes, list[Outcome]]]:
    own = [[outcome for outcome in outcomes if outcome.run.case == case] for case in comparison.cases]
    return list(zip(panels, own, strict=True))
