"""Figures 1, 20 and 22 of the paper, drawn from the graphs of our own scenarios."""

import networkx as nx
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drake_formation.formation import graphs
from drake_formation.paper.runs import FORMATIONS, TOPOLOGIES, topology
from drake_formation.scenario import load_scenario, resolve
from drake_formation.viz.figures.looks import COLOURS
from drake_formation.viz.figures.panels import INCH, WIDTHS

Array = NDArray[np.float64]

PAGE = WIDTHS["page"] / INCH
"""Width of the figures (inches)."""


def mass_spring_model() -> Figure:
    """The quadrilateral as masses and springs (Fig. 1)."""
    scenario = load_scenario("quadrilateral")
    figure = Figure(figsize=(0.5 * PAGE, 0.5 * PAGE), layout="constrained")
    draw_graph(figure.subplots(), resolve(scenario).slots, resolve(scenario).springs.graph, springs=True)
    return figure


def formations() -> Figure:
    """The three formations with every physical interaction (Fig. 20)."""
    figure = Figure(figsize=(PAGE, 0.36 * PAGE), layout="constrained")
    for axes, name in zip(figure.subplots(1, len(FORMATIONS)), FORMATIONS, strict=True):
        scenario = load_scenario(name)
        graph = resolve(scenario).springs.graph
        draw_graph(axes, resolve(scenario).slots, graph, springs=True)
        axes.set_title(f"{name}: {graph.number_of_edges()} spring(s)")
    return figure


def topologies() -> Figure:
    """The communication topologies (Fig. 22)."""
    figure = Figure(figsize=(PAGE, 0.26 * PAGE), layout="constrained")
    for axes, name in zip(figure.subplots(1, len(TOPOLOGIES)), TOPOLOGIES, strict=True):
        scenario = topology(name)
        graph = resolve(scenario).channels.graph
        draw_graph(axes, resolve(scenario).slots, graph)
        axes.set_title(f"{name}\nλ₂ = {graphs.algebraic_connectivity(graph):.3g}", fontsize="small")
    return figure


def draw_graph(axes: Axes, slots: Array, graph: nx.Graph, springs: bool = False) -> None:
    """Robots in their slots and the edges between them, as springs or as lines."""
    for i, j in graphs.edges(graph):
        x, y = (spring_shape if springs else np.array)(slots[[i, j]]).T
        axes.plot(x, y, color=COLOURS[1] if springs else COLOURS[0], linewidth=1, zorder=1)
    for robot, (x, y) in enumerate(slots, start=1):
        axes.plot([x], [y], "o", markersize=11, color="white", markeredgecolor="black", zorder=2)
        axes.text(x, y, str(robot), ha="center", va="center", fontsize="small", zorder=3)
    axes.set(aspect="equal", xticks=[], yticks=[])
    middle, reach = slots.mean(axis=0), 0.7 * float(np.ptp(slots, axis=0).max())
    axes.set_xlim(middle[0] - reach, middle[0] + reach)
    axes.set_ylim(middle[1] - reach, middle[1] + reach)
    axes.axis("off")


def spring_shape(ends: Array) -> Array:
    """A zigzag between two points, nearer to the first so that crossing springs stay apart; shape (points, 2)."""
    along = ends[1] - ends[0]
    across = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    places = np.concatenate([[0.0], np.linspace(0.2, 0.45, 13), [1.0]])
    swings = 0.025 * np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], 6)[:11], [0.0, 0.0]])
    shape: Array = ends[0] + np.outer(places, along) + np.outer(swings, across)
    return shape
