"""What every channel buys: consensus error against communication channels, and the spectra that explain it."""

from collections import Counter

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from drake_formation.analysis.topology.results import GraphPoint, ParetoFront

MOST_DRAWN = 12
"""Points up to which every graph is drawn."""

BEST_COLOUR = colormaps["tab10"](0)
SPECTRUM_COLOUR = colormaps["tab10"](1)
OTHER_COLOUR = "0.7"


def error_against_channels(front: ParetoFront) -> Figure:
    """Consensus error of the best graph for every number of channels, with its Laplacian eigenvalues.

    Args:
        front: from :func:`drake_formation.analysis.topology.cheapest_graph.pareto_front`.
    """
    figure = Figure(figsize=(8, 7), layout="constrained")
    few = len(front.points) <= MOST_DRAWN
    rows = figure.subplots(3 if few else 2, sharex=True, height_ratios=[3, 2, 1] if few else [3, 2])
    _draw_errors(rows[0], front)
    _draw_spectra(rows[1], front)
    if few:
        _draw_graphs(rows[2], front)
    rows[0].set_title(front.measure)
    rows[-1].set_xlabel("communication channels (two an edge)")
    if few:
        rows[-1].set_xticks([point.channels for point in front.points])
    else:
        rows[-1].xaxis.set_major_locator(MaxNLocator(steps=[2, 4, 10]))  # channels come in pairs
    rows[-1].set_xlim(front.points[0].channels - 1.2, front.points[-1].channels + 1.2)
    return figure


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
    axes.set_ylabel("consensus error (mm)")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", frameon=False)


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
    axes.plot(channels, connectivity, color=SPECTRUM_COLOUR, linewidth=0.8, label="algebraic connectivity λ₂")
    neighbours = [_fewest_neighbours(point) for point in front.points]
    axes.plot(channels, neighbours, "_", color="0.2", markersize=14, label="fewest neighbours of a robot")
    axes.set_ylabel("Laplacian eigenvalues")
    axes.set_ylim(0, 1.4 * max(point.spectrum[-1] for point in front.points))  # the legend goes above them
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", frameon=False, loc="upper left", ncols=2)


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
