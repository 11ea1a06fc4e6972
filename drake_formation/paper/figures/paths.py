"""Figures 7, 15 and 21: paths past the obstacles, with the deviation drawn larger than it is."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drake_formation.paper.figures.curves import PAGE, phase
from drake_formation.paper.readings.two_readings import PROBABLE
from drake_formation.paper.runs import GAINS, MATERIALS
from drake_formation.paper.store import Store
from drake_formation.vectors import length_of
from drake_formation.viz.figures import draw_formation, robot_looks, snapshot_times
from drake_formation.viz.obstacles import OBSTACLE_COLOUR

SHOWN = 0.8
"""How large the largest deviation is drawn, at the least (m): as large as a formation nearly, on a way of 25."""


def transport_paths(formation: str, store: Store) -> Figure:
    """Paths past the obstacles for both materials and three gains, and where obstacles push robots out of shape."""
    figure = Figure(figsize=(PAGE, 0.42 * PAGE), layout="constrained")
    panels = figure.subplots(len(GAINS), len(MATERIALS), sharex=True, sharey=True)
    for column, (material, stiffness) in enumerate(MATERIALS.items()):
        for row, delta in enumerate(GAINS):
            carried = phase(store[PROBABLE.transport(formation, material, delta)], 1)
            larger = exaggeration(carried)
            axes = panels[row, column]
            draw_transport(axes, exaggerated(carried, larger))
            title = f"{material}, $k$ = {stiffness:g} N/m, δ = {delta:g} N/m; deviation × {larger}"
            axes.set_title(title, fontsize="small")
        panels[-1, column].set_xlabel("$x$ (m)")
    for axes in panels[:, 0]:
        axes.set_ylabel("$y$ (m)")
    return figure


def exaggeration(carried: xr.Dataset) -> int:
    """How many times larger the deviation from the obstacle-free response is drawn."""
    largest = float(length_of(carried["deviation"].values).max())
    return max(int(np.ceil(SHOWN / largest)), 1) if largest else 1


def exaggerated(carried: xr.Dataset, larger: int) -> xr.Dataset:
    """A transport with its deviation from the obstacle-free response so many times as large."""
    return carried.assign(position=carried["position"] + (larger - 1) * carried["deviation"])


def draw_transport(axes: Axes, carried: xr.Dataset) -> None:
    """Paths, obstacles and snapshots of one transport; obstacles as points, as their fields may be wider than all."""
    for robot, its in robot_looks(carried).items():
        x, y = carried["position"].sel(robot=robot).values.T
        axes.plot(x, y, color=its.colour)
    for x, y in carried["obstacle_position"].values:
        axes.plot([x], [y], "X", color=OBSTACLE_COLOUR, markersize=5)
    for time in snapshot_times(carried):
        draw_formation(axes, carried.sel(time=time))
    axes.margins(y=0.15)
    axes.set(aspect="equal")
