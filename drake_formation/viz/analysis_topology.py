"""What every channel buys: consensus error against communication channels, and the spectra that explain it."""

from collections import Counter
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from drake_formation.analysis.topology.results import GraphPoint, ParetoFront
from drake_formation.viz.figures.looks import COLOURS
from drake_formation.viz.figures.panels import Width, drawing, height, legend

MOST_DRAWN = 12
"""Points up to which every graph is drawn."""

BEST_COLOUR = COLOURS[0]
SPECTRUM_COLOUR = COLOURS[1]
OTHER_COLOUR = "0.7"


def error_against_channels(
    front: ParetoFront, axes: Sequence[Axes] | None = None, *, width: Width = "page"
) -> list[Axes]:
    """Consensus error of the best graph for every number of channels, with its Laplacian eigenvalues.

    Args:
        front: from :func:`drake_formation.analysis.topology.cheapest_graph.pareto_front`.
        axes: where to draw, two or, where the graphs are drawn too, three; a figure of their own if not given.
        width: of that figure.
    """
    few = len(front.points) <= MOST_DRAWN
    row = height(width, alone=False)
    heights = [1.5 * row, row, 0.6 * row] if few else [1.5 * row, row]
    with drawing(axes, heights, width, title=front.measure, sharex=True) as panels:
        _draw_errors(panels[0], front)
        _draw_spectra(panels[1], front)
        if few:
            _draw_graphs(panels[2], front)
            panels[-1].set_xticks([point.channels for point in front.points])
        else:
            panels[-1].xaxis.set_major_locator(MaxNLocator(steps=[2, 4, 10]))  # channels come in pairs
        panels[-1].set_xlabel("communication channels (two an edge)")
        panels[-1].set_xlim(front.points[0].channels - 1.2, front.points[-1].channels + 1.2)
    return panels


def _draw_errors(axes: Axes, front: ParetoFront) -> None:
    channels = [point.channels for point in front.points]
    tried, errors = front.tried.T
    axes.plot(tried, 1000 * errors, "o", color=OTHER_COLOUR, markersize=3, label="other graphs tried", zorder=1)
    label = "best of all graphs" if front.exact else "best graph found"
    axes.plot(channels, [1000 * point.error_m for point in front.points], "o", color=BEST_COLOUR, label=label, zorder=3)
    kept = front.front
    steps = [1000 * point.error_m for point in kept]
    axes.step(
        [*(point.channels for point in kept), channels[-1]],
        [*steps, steps[-1]],
        where="post",
        color=BEST_COLOUR,
        linewidth=1.2,
        label="Pareto front",
        zorder=2,
    )
    bounds = 1000 * np.array([point.bound_m for point in front.points])
    if not front.exact and np.all(bounds > 0):
        axes.plot(channels, bounds, "--", color="0.3", linewidth=1, label="no graph is better", zorder=2)
    axes.set_ylim(0, min(1.05 * axes.dataLim.y1, 2.2 * max(steps)))
    axes.set_ylabel("consensus error\n$\\|e_i\\|$ (mm)")
    legend(axes)


def _draw_spectra(axes: Axes, front: ParetoFront) -> None:
    """Eigenvalues as dots, the larger the more often one occurs."""
    for point in front.points:
        counted = Counter(round(value, 6) for value in point.spectrum[1:])
        axes.scatter(
            [point.channels] * len(counted),
            list(counted),
            s=[18 * count for count in counted.values()],
            color=SPECTRUM_COLOUR,
            linewidths=0,
        )
    channels = [point.channels for point in front.points]
    connectivity = [point.spectrum[1] for point in front.points]
    axes.plot(channels, connectivity, color=SPECTRUM_COLOUR, linewidth=0.8, label=r"algebraic connectivity $\lambda_2$")
    neighbours = [_fewest_neighbours(point) for point in front.points]
    axes.plot(channels, neighbours, "_", color="0.2", markersize=14, label="fewest neighbours of a robot")
    axes.set_ylabel(r"Laplacian eigenvalues $\lambda$ (1)")
    axes.set_ylim(0, 1.1 * max(point.spectrum[-1] for point in front.points))
    legend(axes)


def _draw_graphs(axes: Axes, front: ParetoFront) -> None:
    """Every point's graph under it, robots on a circle, the first at the upper left, counter-clockwise."""
    axes.set_ylim(-1.2, 1.2)
    axes.set_yticks([])
    axes.spines[["left", "right", "top"]].set_visible(False)
    kept = {point.channels for point in front.front}
    for point in front.points:
        robots = len(point.spectrum)
        angles = np.pi * (0.5 + 1 / robots) + 2 * np.pi * np.arange(robots) / robots
        colour = BEST_COLOUR if point.channels in kept else "0.5"
        inset = axes.inset_axes((point.channels - 0.9, -1.1, 1.8, 2.2), transform=axes.transData)
        places = np.column_stack([np.cos(angles), np.sin(angles)])
        for i, j in point.edges:
            inset.plot(*places[[i - 1, j - 1]].T, color=colour, linewidth=1.1)
        inset.plot(*places.T, "o", color=colour, markersize=3.5)
        inset.set_aspect("equal")
        inset.margins(0.15)
        inset.set_axis_off()


def _fewest_neighbours(point: GraphPoint) -> int:
    counted = Counter(robot for edge in point.edges for robot in edge)
    return min(counted.values())
