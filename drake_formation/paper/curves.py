"""Figures 4-19, 21 and 23 of the paper, redrawn from our runs."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drake_formation.measuring import metrics
from drake_formation.paper.runs import AGGREGATION_GAINS, GAINS, MATERIALS, TOPOLOGIES, aggregation, topology, transport
from drake_formation.paper.store import Store
from drake_formation.vectors import length
from drake_formation.viz.figures import draw_formation, robot_colours, snapshot_times
from drake_formation.viz.obstacles import draw_obstacles

Array = NDArray[np.float64]

STYLES = dict(zip(GAINS, ("-", "--", ":"), strict=True))
COLOURS = {"rubber": "tab:blue", "steel": "tab:red"}


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
    """Norm of the consensus error of all robots for three gains (Figs. 6 and 14)."""
    figure, axes = _panel("‖e‖ (m)")
    for delta in AGGREGATION_GAINS:
        gathering = phase(store[aggregation(formation, delta)], 0)
        axes.plot(gathering["time"], whole_error(gathering), label=f"δ = {delta:g} N/m")
    _finish(axes)
    return figure


def transport_paths(formation: str, store: Store) -> Figure:
    """Paths past the obstacles for both materials and three gains (Figs. 7, 15 and 21)."""
    figure = Figure(figsize=(12, 5.6), layout="constrained")
    panels = figure.subplots(len(GAINS), len(MATERIALS), sharex=True, sharey=True)
    for column, (material, stiffness) in enumerate(MATERIALS.items()):
        for row, delta in enumerate(GAINS):
            axes = panels[row, column]
            carried = phase(store[transport(formation, material, delta)], 1)
            draw_transport(axes, carried)
            axes.set_title(f"{material}, k = {stiffness:g} N/m, δ = {delta:g} N/m", fontsize="medium")
        panels[-1, column].set_xlabel("x (m)")
    for axes in panels[:, 0]:
        axes.set_ylabel("y (m)")
    return figure


def draw_transport(axes: Axes, carried: xr.Dataset) -> None:
    """Paths, obstacles and snapshots of one transport."""
    for robot, colour in robot_colours(carried).items():
        x, y = carried["position"].sel(robot=robot).values.T
        axes.plot(x, y, color=colour, linewidth=1.2)
    draw_obstacles(axes, carried, snapshot_times(carried))
    for time in snapshot_times(carried):
        draw_formation(axes, carried.sel(time=time))
    axes.set(aspect="equal")
    axes.grid(alpha=0.3)


def velocities(formation: str, store: Store) -> Figure:
    """Velocities of the robots at δ = 0 for both materials (Figs. 8 and 16)."""
    figure = Figure(figsize=(9, 5), layout="constrained")
    panels = figure.subplots(2, len(MATERIALS), sharex=True, sharey="row")
    for column, material in enumerate(MATERIALS):
        carried = phase(store[transport(formation, material, 0.0)], 1)
        for row, axis in enumerate(("x", "y")):
            axes = panels[row, column]
            for robot, colour in robot_colours(carried).items():
                axes.plot(
                    since_hand_off(carried),
                    carried["velocity"].sel(robot=robot, axis=axis),
                    color=colour,
                    linestyle="-" if robot % 2 else "--",
                    label=f"robot {robot}",
                )
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
            carried = phase(store[transport(formation, material, delta)], 1)
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
        axes.set_ylabel("‖ε‖ (cm)")
        _finish(axes)
    return figure


def relative_distance(store: Store) -> Figure:
    """Distance d12 at δ = 0 for both materials (Fig. 10)."""
    figure, axes = _panel("d12 (m)", "time since hand-off (s)")
    for material, colour in COLOURS.items():
        carried = phase(store[transport("line", material, 0.0)], 1)
        axes.plot(since_hand_off(carried), carried["spring_length"].sel(spring="1-2"), color=colour, label=material)
    _finish(axes)
    return figure


def consensus_errors(formation: str, store: Store) -> Figure:
    """Consensus error of the robot farthest off for both materials and three gains (Figs. 11 and 18)."""
    figure, axes = _panel("‖e‖ (cm), largest within each half second", "time since hand-off (s)")
    for material, colour in COLOURS.items():
        for delta in GAINS:
            carried = phase(store[transport(formation, material, delta)], 1)
            time, error = envelope(carried, 100 * length(carried["consensus_error"]).max("robot"))
            axes.plot(time, error, color=colour, linestyle=STYLES[delta], label=f"{material}, δ = {delta:g}")
    axes.set_yscale("log")
    axes.set_ylim(bottom=1e-3)
    _finish(axes)
    return figure


def topology_bars(store: Store) -> Figure:
    """Largest consensus error by communication topology and without communication (Fig. 23)."""
    runs = {"local LQR": transport("quadrilateral", "rubber", 0.0)} | {name: topology(name) for name in TOPOLOGIES}
    bars = {name: metrics(store[run]).consensus_error_m for name, run in runs.items()}
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    drawn = axes.bar(
        list(bars), [100 * error for error in bars.values()], color=["0.6"] + ["tab:blue"] * len(TOPOLOGIES)
    )
    axes.bar_label(drawn, fmt="%.2f")
    axes.margins(y=0.1)
    axes.set_ylabel("largest ‖e‖ (cm)")
    axes.tick_params("x", labelrotation=20)
    return figure


def phase(result: xr.Dataset, number: int) -> xr.Dataset:
    """The part of a result in one phase: 0 aggregation, 1 transport."""
    return result.isel(time=result["phase"].values == number)


def since_hand_off(carried: xr.Dataset) -> xr.DataArray:
    """Time since the object was placed (s)."""
    return carried["time"] - carried["time"][0]


def envelope(carried: xr.Dataset, series: xr.DataArray, width: float = 0.5) -> tuple[Array, Array]:
    """The largest value within each window of a width (s), and the windows' middles: fast ringing as one line."""
    window = (since_hand_off(carried).values / width).astype(int)
    starts = np.flatnonzero(np.diff(window, prepend=-1))
    return (window[starts] + 0.5) * width, np.maximum.reduceat(series.values, starts)


def whole_error(result: xr.Dataset) -> xr.DataArray:
    """Norm of the consensus error of all robots together (m), the paper's ‖e‖."""
    squared = (result["consensus_error"] ** 2).sum(["robot", "axis"])
    return squared**0.5


def _panel(label: str, time: str = "time (s)") -> tuple[Figure, Axes]:
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    axes.set(xlabel=time, ylabel=label)
    return figure, axes


def _finish(axes: Axes) -> None:
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small", frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
