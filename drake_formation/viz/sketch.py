"""A scenario before it runs: where robots start, gather and are to go, what binds them, and what is in their way."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.viz.figures.looks import look
from drake_formation.viz.obstacles import OBSTACLE_COLOUR, grown
from drake_formation.viz.outline import rigid_outline
from drake_formation.viz.palette import CHANNEL

Array = NDArray[np.float64]

SPRING_COLOUR, BODY_COLOUR = "0.45", "0.88"
WIDTH, LOWEST, HIGHEST = 11.0, 3.8, 8.0
"""Of the figure (inches)."""

MOST_NAMED = 30
"""More robots than this have no numbers."""


def sketch(formation: Formation) -> Figure:
    """Draw a formation on its way from start to goal, and beside it, larger, its springs and channels."""
    figure = Figure(layout="constrained")
    plan, links = figure.subplots(1, 2, width_ratios=[3, 1])
    gathered = formation.centre + formation.slots
    _draw_obstacles(plan, formation)
    _draw_way(plan, formation, gathered)
    _draw_links(links, formation)
    plan.set(xlabel="x (m)", ylabel="y (m)", title=f"{formation.name}: before it runs")
    links.set(xlabel="x (m)", title="about the centre")
    _fit_to_plane(figure, plan)
    for axes in (plan, links):
        axes.grid(alpha=0.3)
        axes.set_aspect("equal")
    figure.legend(loc="outside lower center", ncols=4, fontsize="small", frameon=False)
    return figure


def _draw_way(axes: Axes, formation: Formation, gathered: Array) -> None:
    """Robots at their starts, at the slots where they gather if they do, and at the goal."""
    if formation.has_body:
        axes.fill(*(formation.centre + rigid_outline(formation)).T, color=BODY_COLOUR, label="object")
    ways = zip(formation.starts, gathered, formation.goal + formation.slots, strict=True)
    for robot, (start, slot, end) in enumerate(ways, start=1):
        colour = look(robot).colour
        axes.plot(*np.stack([slot, end]).T, "-", color=colour, linewidth=0.6, alpha=0.5)
        axes.plot(*np.stack([start, slot]).T, ":", color=colour, linewidth=0.9)
        axes.plot(*start, "s", color=colour, markersize=5)
        axes.plot(*slot, "o", color=colour, markersize=6, markeredgecolor="white")
        axes.plot(*end, "o", color=colour, markersize=6, fillstyle="none")
    for marker, fill, label in (("s", "full", "start"), ("o", "full", "slot"), ("o", "none", "slot at the goal")):
        axes.plot([], [], marker, color="0.3", fillstyle=fill, markersize=5, label=label)


def _draw_links(axes: Axes, formation: Formation) -> None:
    """The slots with the robots' numbers, springs as lines, and channels as arrows bent beside them, one each way."""
    slots = formation.slots
    if formation.has_body:
        axes.fill(*rigid_outline(formation).T, color=BODY_COLOUR)
    springs = [slots[[i, j]] for i, j in formation.springs.pairs.tolist()]
    if springs:
        axes.add_collection(LineCollection(springs, colors=SPRING_COLOUR, linewidths=2.0, zorder=1, label="spring"))
    for listener, speaker in formation.channels.pairs.tolist():
        axes.add_patch(
            FancyArrowPatch(
                slots[speaker],
                slots[listener],
                arrowstyle="-|>",
                connectionstyle="arc3,rad=0.12",
                shrinkA=6,
                shrinkB=6,
                mutation_scale=7,
                color=CHANNEL,
                linewidth=0.7,
                alpha=0.7,
                zorder=1,
            )
        )
    if len(formation.channels.pairs):
        axes.plot([], [], color=CHANNEL, linewidth=0.8, label="channel, to the robot that hears")
    for number, (slot, radius) in enumerate(zip(slots, formation.footprints.tolist(), strict=True), start=1):
        colour = look(number).colour
        axes.plot(*slot, "o", color=colour, markersize=9)
        axes.add_patch(Circle((float(slot[0]), float(slot[1])), radius, color=colour, alpha=0.2, linewidth=0))
        if formation.robots <= MOST_NAMED:
            axes.annotate(str(number), slot, ha="center", va="center", fontsize=6, color="white")
    axes.margins(0.15)


def _draw_obstacles(axes: Axes, formation: Formation) -> None:
    """Obstacles where they are at first, their range, and where those that move end up."""
    for k, obstacle in enumerate(formation.obstacles):
        vertices, first = obstacle.outline(formation.begin), k == 0
        if len(vertices) == 1:  # also one without extent is to be seen
            axes.plot(*vertices.T, "X", color=OBSTACLE_COLOUR, markersize=7)
        shape = grown(vertices, obstacle.radius, color=OBSTACLE_COLOUR, alpha=0.5)
        shape.set_label("obstacle" if first else "")
        axes.add_patch(shape)
        if formation.felt_within:
            range_ = grown(
                vertices, obstacle.radius + formation.felt_within, fill=False, linestyle="--", edgecolor="0.5"
            )
            range_.set_label("range in which it is felt" if first else "")
            axes.add_patch(range_)
        if len(obstacle.motion):
            times = np.unique(np.clip(obstacle.motion[:, :2].ravel(), formation.begin, formation.end))
            way = vertices.mean(axis=0) - obstacle.displacement(formation.begin) + obstacle.displacement(times)
            axes.plot(*way.T, "-.", color=OBSTACLE_COLOUR, linewidth=1.0)
            axes.add_patch(grown(obstacle.outline(float(times[-1])), obstacle.radius, color=OBSTACLE_COLOUR, alpha=0.2))


def _fit_to_plane(figure: Figure, axes: Axes) -> None:
    """Give the figure the shape of what it shows."""
    axes.autoscale_view()
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    height = 0.65 * WIDTH * (top - bottom) / (right - left) + 1.5
    figure.set_size_inches(WIDTH, min(max(height, LOWEST), HIGHEST))
