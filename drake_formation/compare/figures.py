"""Figures of a comparison: paths and errors laid over each other, one colour a law, and error against effort."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from drake_formation.compare.comparison import Comparison
from drake_formation.compare.run import Outcome
from drake_formation.compare.table import Row
from drake_formation.scenario import resolve
from drake_formation.viz.obstacles import OBSTACLE_COLOUR, grown
from drake_formation.viz.style import draw_each

ERROR, EFFORT = "consensus_error_m", "rms_force_n"
"""The metrics of the Pareto plot."""


def write_comparison_figures(
    comparison: Comparison, outcomes: Sequence[Outcome], table: Sequence[Row], folder: Path
) -> dict[str, str]:
    """Draw all figures as PNG files in a folder that exists; gives those that failed, and why."""
    drawn: dict[str, Callable[[], Figure]] = {
        "paths": partial(paths, comparison, outcomes),
        "consensus_error": partial(consensus_error, comparison, outcomes),
        "error_against_effort": partial(error_against_effort, comparison, table),
    }
    return draw_each(drawn, folder)


def law_colours(comparison: Comparison) -> dict[str, str]:
    """A colour for each law, the same in every figure."""
    count = len(comparison.laws)
    if count <= 10:
        return {law: to_hex(colormaps["tab10"](k)) for k, law in enumerate(comparison.laws)}
    return {law: to_hex(colormaps["turbo"](k / (count - 1))) for k, law in enumerate(comparison.laws)}


def paths(comparison: Comparison, outcomes: Sequence[Outcome]) -> Figure:
    """Where the robots go while they carry the object, the first run of every law; a panel a case."""
    figure, panels = _panels(comparison, height=1.9)
    for axes, own in _by_case(comparison, outcomes, panels):
        firsts = {outcome.run.law: outcome for outcome in reversed(own)}
        for law, colour in law_colours(comparison).items():
            x, y = np.moveaxis(firsts[law].position[firsts[law].carried], -1, 0)
            axes.plot(x, y, color=colour, linewidth=1.0, alpha=0.8)
        formation = resolve(own[0].run.scenario)
        for obstacle in formation.obstacles:
            if len(obstacle.vertices) == 1 and not len(obstacle.motion):
                axes.plot(*obstacle.vertices.T, "X", color=OBSTACLE_COLOUR, markersize=7)
            outline = obstacle.outline(formation.hand_off)
            axes.add_patch(grown(outline, obstacle.radius, color=OBSTACLE_COLOUR, alpha=0.5))
        axes.set(ylabel="y (m)")
        axes.set_aspect("equal")
        axes.margins(0.02, 0.1)
    panels[-1].set_xlabel("x (m)")
    _legend(figure, comparison)
    return figure


def consensus_error(comparison: Comparison, outcomes: Sequence[Outcome]) -> Figure:
    """The largest consensus error of any robot over time (paper, Eq. 19), all runs of every law; a panel a case."""
    figure, panels = _panels(comparison, height=2.8)
    colours = law_colours(comparison)
    for axes, own in _by_case(comparison, outcomes, panels):
        for outcome in own:
            error = np.maximum(outcome.consensus_error, 1e-12)
            axes.plot(outcome.times, error, color=colours[outcome.run.law], linewidth=1.1, alpha=0.85)
        axes.set(ylabel="consensus error (m)", yscale="log")
        top = max(float(axes.dataLim.y1), 1e-6)
        axes.set_ylim(max(float(axes.dataLim.y0), top * 1e-6) / 2, top * 2)
    panels[-1].set_xlabel("time (s)")
    _legend(figure, comparison)
    return figure


def error_against_effort(comparison: Comparison, table: Sequence[Row]) -> Figure:
    """Largest consensus error against RMS force, means over the runs; a line joins laws that none beats in both."""
    figure, panels = _panels(comparison, height=3.6)
    colours = law_colours(comparison)
    for axes, case in zip(panels, comparison.cases, strict=True):
        points = {}
        for row in table:
            error, effort = row.cells[ERROR], row.cells[EFFORT]
            if row.case == case and np.isfinite([error.mean, effort.mean]).all():
                points[row.law] = effort.mean, error.mean
                axes.errorbar(
                    effort.mean, error.mean, xerr=effort.spread or None, yerr=error.spread or None,
                    fmt="o", color=colours[row.law], markersize=7,
                )  # fmt: skip
        front = sorted(point for point in points.values() if not any(_beats(other, point) for other in points.values()))
        axes.plot(*zip(*front, strict=True), color="0.6", linewidth=1.0, zorder=0) if front else None
        axes.set(ylabel="largest consensus error (m)", xscale="log", yscale="log")
    panels[-1].set_xlabel("RMS control force (N)")
    _legend(figure, comparison)
    return figure


def _beats(one: tuple[float, float], other: tuple[float, float]) -> bool:
    return one != other and one[0] <= other[0] and one[1] <= other[1]


def _panels(comparison: Comparison, height: float) -> tuple[Figure, list[Axes]]:
    """A panel a case, one above the other."""
    count = len(comparison.cases)
    figure = Figure(figsize=(9, height * count + 0.9), layout="constrained")
    panels = list(np.ravel(figure.subplots(count, squeeze=False)))
    for axes, case in zip(panels, comparison.cases, strict=True):
        axes.grid(alpha=0.3)
        if count > 1:
            axes.set_title(case, fontsize="medium")
    figure.suptitle(comparison.description or comparison.name, fontsize="medium")
    return figure, panels


def _by_case(
    comparison: Comparison, outcomes: Sequence[Outcome], panels: Sequence[Axes]
) -> list[tuple[Axes, list[Outcome]]]:
    own = [[outcome for outcome in outcomes if outcome.run.case == case] for case in comparison.cases]
    return list(zip(panels, own, strict=True))


def _legend(figure: Figure, comparison: Comparison) -> None:
    from matplotlib.lines import Line2D

    lines = [Line2D([], [], color=colour, linewidth=3, label=law) for law, colour in law_colours(comparison).items()]
    figure.legend(handles=lines, loc="outside lower center", ncols=4, fontsize="small", frameon=False)
