"""Figures 4-18 and 23 of the paper, redrawn from our runs; transports as probably simulated."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drake_formation.paper.readings.two_readings import PROBABLE, READINGS
from drake_formation.paper.runs import AGGREGATION_GAINS, GAINS, MATERIALS, TOPOLOGIES, aggregation
from drake_formation.paper.store import Store
from drake_formation.vectors import length
from drake_formation.viz.figures import robot_colours

Array = NDArray[np.float64]

STYLES = dict(zip(GAINS, ("-", "--", ":"), strict=True))
COLOURS = {"rubber": "tab:blue", "steel": "tab:red"}
PIXELS = 400
"""Columns that a band is resolved to, no more than an axes has pixels across."""
FARTHEST = "largest ‖e_i‖"
"""What the consensus error is in tables and figures: that of the robot farthest off."""


def aggregation_paths(formation: str, store: Store) -> Figure:
    """Paths of the robots to their slots at δ = 0 (Figs. 4 and 12)."""
    gathering = phase(store[aggregation(formation, 0.0)], 0)
    figure = Figure(figsize=(5, 4.5), layout="constrained")
    axes = figure.subplots()
    for robot, colour in robot_colours(gathering).items():
        x, y = gathering["position"].sel(robot=robot).values.T
        axes.plot(x, y, color=colour, label=f"robot {robot}")
        axes.plot(x[:1], y[:1], "s", color=colour)
        axes.plot(x[-1:], y[-1:], "o", color=colour)
    axes.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
    _finish(axes)
    return figure


def aggregation_positions(formation: str, store: Store) -> Figure:
    """Positions in time for three consensus gains (Figs. 5 and 13)."""
    figure = Figure(figsize=(9, 5.5), layout="constrained")
    panels = figure.subplots(2, len(AGGREGATION_GAINS), sharex=True, sharey="row")
    for column, delta in enumerate(AGGREGATION_GAINS):
        gathering = phase(store[aggregation(formation, delta)], 0)
        for row, axis in enumerate(("x", "y")):
            axes = panels[row, column]
            for robot, colour in robot_colours(gathering).items():
                position = gathering["position"].sel(robot=robot, axis=axis)
                axes.plot(gathering["time"], position, color=colour, label=f"robot {robot}")
            axes.grid(alpha=0.3)
        panels[0, column].set_title(f"δ = {delta:g} N/m", fontsize="medium")
        panels[1, column].set_xlabel("time (s)")
    panels[0, 0].set_ylabel("x (m)")
    panels[1, 0].set_ylabel("y (m)")
    panels[0, -1].legend(fontsize="small", frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def aggregation_errors(formation: str, store: Store) -> Figure:
    """Consensus error of the robot farthest off for three gains (Figs. 6 and 14)."""
    figure, axes = _panel(f"{FARTHEST} (m)")
    for delta in AGGREGATION_GAINS:
        gathering = phase(store[aggregation(formation, delta)], 0)
        axes.plot(gathering["time"], farthest(gathering), label=f"δ = {delta:g} N/m")
    _finish(axes)
    return figure


def velocities(formation: str, store: Store) -> Figure:
    """Velocities of the robots at δ = 0 for both materials (Figs. 8 and 16)."""
    figure = Figure(figsize=(9, 5), layout="constrained")
    panels = figure.subplots(2, len(MATERIALS), sharex=True, sharey="row")
    for column, material in enumerate(MATERIALS):
        carried = phase(store[PROBABLE.transport(formation, material, 0.0)], 1)
        for row, axis in enumerate(("x", "y")):
            axes = panels[row, column]
            for robot, colour in robot_colours(carried).items():
                style = "-" if robot % 2 else "--"
                velocity = carried["velocity"].sel(robot=robot, axis=axis)
                draw_band(axes, since_hand_off(carried), velocity, colour, style, f"robot {robot}")
            axes.set_ylabel(f"v_{axis} (m/s)" if column == 0 else "")
            axes.grid(alpha=0.3)
        panels[0, column].set_title(f"{material}, δ = 0", fontsize="medium")
        panels[1, column].set_xlabel("time since hand-off (s)")
    panels[0, -1].legend(fontsize="small", frameon=False)
    return figure


def tracking_errors(formation: str, store: Store) -> Figure:
    """Tracking error at each gain: the robot farthest off, and each robot at δ = 0 (Figs. 9 and 17)."""
    figure = Figure(figsize=(9, 6.5), layout="constrained")
    single, gains = figure.subplots(2, sharex=True)
    for material, colour in COLOURS.items():
        for delta in GAINS:
            carried = phase(store[PROBABLE.transport(formation, material, delta)], 1)
            error = 100 * length(carried["deviation"])
            label = f"{material}, δ = {delta:g}"
            gains.plot(since_hand_off(carried), error.max("robot"), color=colour, linestyle=STYLES[delta], label=label)
            for robot in carried["robot"].values if delta == 0 else ():
                style = "-" if robot % 2 else "--"
                each = error.sel(robot=robot)
                single.plot(since_hand_off(carried), each, style, color=colour, label=f"{material}, robot {robot}")
    single.set_title("δ = 0, each robot", fontsize="medium")
    gains.set_title("largest of all robots", fontsize="medium")
    gains.set_xlabel("time since hand-off (s)")
    for axes in (single, gains):
        axes.set_ylabel("‖ε_i‖ (cm)")
        _finish(axes)
    return figure


def relative_distance(store: Store) -> Figure:
    """Distance d12 at δ = 0 for both materials (Fig. 10)."""
    figure, axes = _panel("d12 (m)", "time since hand-off (s)")
    for material, colour in COLOURS.items():
        carried = phase(store[PROBABLE.transport("line", material, 0.0)], 1)
        distance = carried["spring_length"].sel(spring="1-2")
        draw_band(axes, since_hand_off(carried), distance, colour, "-", material)
    _finish(axes)
    return figure


def consensus_errors(formation: str, store: Store) -> Figure:
    """Consensus error of the robot farthest off for both materials and three gains (Figs. 11 and 18)."""
    figure, axes = _panel(f"{FARTHEST} (cm), within each half second", "time since hand-off (s)")
    for material, colour in COLOURS.items():
        for delta in GAINS:
            carried = phase(store[PROBABLE.transport(formation, material, delta)], 1)
            middles, _, highest = windows(since_hand_off(carried).values, 100 * farthest(carried).values, 0.5)
            axes.plot(middles, highest, color=colour, linestyle=STYLES[delta], label=f"{material}, δ = {delta:g}")
    axes.set_yscale("log")
    axes.set_ylim(bottom=1e-3)
    _finish(axes)
    return figure


def topology_bars(store: Store) -> Figure:
    """Largest consensus error by communication topology and without communication, by both readings (Fig. 23)."""
    figure = Figure(figsize=(12, 4), layout="constrained")
    for axes, reading in zip(figure.subplots(1, len(READINGS), sharey=True), READINGS.values(), strict=True):
        local = reading.transport("quadrilateral", "rubber", 0.0)
        runs = {"local LQR": local} | {name: reading.topology(name) for name in TOPOLOGIES}
        errors = [100 * store.measured(run).consensus_error_m for run in runs.values()]
        drawn = axes.bar(list(runs), errors, color=["0.6"] + ["tab:blue"] * len(TOPOLOGIES))
        axes.bar_label(drawn, fmt="%.2f")
        axes.margins(y=0.1)
        axes.set_title(reading.title, fontsize="medium")
        axes.tick_params("x", labelrotation=25)
    figure.axes[0].set_ylabel(f"{FARTHEST} (cm)")
    return figure


def phase(result: xr.Dataset, number: int) -> xr.Dataset:
    """The part of a result in one phase: 0 aggregation, 1 transport."""
    return result.isel(time=result["phase"].values == number)


def since_hand_off(carried: xr.Dataset) -> xr.DataArray:
    """Time since the object was placed (s)."""
    return carried["time"] - carried["time"][0]


def farthest(result: xr.Dataset) -> xr.DataArray:
    """Consensus error of the robot farthest off (m)."""
    return length(result["consensus_error"]).max("robot")


def windows(time: Array, series: Array, width: float) -> tuple[Array, Array, Array]:
    """The least and the largest value within each window of a width (s), after the windows' middles."""
    window = (time / width).astype(int)
    starts = np.flatnonzero(np.diff(window, prepend=-1))
    middles = (window[starts] + 0.5) * width
    return middles, np.minimum.reduceat(series, starts), np.maximum.reduceat(series, starts)


def draw_band(
    axes: Axes, time: xr.DataArray, series: xr.DataArray, colour: str | tuple[float, ...], style: str, label: str
) -> None:
    """A signal as a line where it is slow, and as the band that it fills where it is faster than a pixel."""
    width = float(time[-1]) / PIXELS
    middles, lowest, highest = windows(time.values, series.values, width)
    axes.plot(middles, 0.5 * (lowest + highest), color=colour, linestyle=style, label=label)
    axes.fill_between(middles, lowest, highest, color=colour, alpha=0.3, linewidth=0)


def _panel(label: str, time: str = "time (s)") -> tuple[Figure, Axes]:
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    axes.set(xlabel=time, ylabel=label)
    return figure, axes


def _finish(axes: Axes) -> None:
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
