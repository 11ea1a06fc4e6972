"""Figures 4-18 and 23 of the paper, redrawn from our runs; transports as probably simulated."""

from collections.abc import Callable

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drake_formation.paper.readings.two_readings import PROBABLE, READINGS
from drake_formation.paper.runs import AGGREGATION_GAINS, GAINS, MATERIALS, TOPOLOGIES, aggregation
from drake_formation.paper.store import Store
from drake_formation.vectors import length
from drake_formation.viz.figures import robot_looks
from drake_formation.viz.figures.envelope import draw_band, windows
from drake_formation.viz.figures.looks import COLOURS as PALETTE
from drake_formation.viz.figures.looks import Look
from drake_formation.viz.figures.panels import INCH, WIDTHS, legend

STYLES = dict(zip(GAINS, ("-", "--", ":"), strict=True))
COLOURS = {"rubber": PALETTE[0], "steel": PALETTE[1]}
PAGE = WIDTHS["page"] / INCH
"""Width of the figures (inches)."""
FARTHEST = r"largest $\|e_i\|$"
"""What the consensus error is in figures: that of the robot farthest off."""
Draw = Callable[[Axes, xr.Dataset, xr.DataArray, Look, str], None]
"""Draws a robot's line from a run and its values, with a look and a label."""


def aggregation_paths(formation: str, store: Store) -> Figure:
    """Paths of the robots to their slots at δ = 0 (Figs. 4 and 12)."""
    gathering = phase(store[aggregation(formation, 0.0)], 0)
    figure = Figure(figsize=(0.6 * PAGE, 0.5 * PAGE), layout="constrained")
    axes = figure.subplots()
    for robot, its in robot_looks(gathering).items():
        x, y = gathering["position"].sel(robot=robot).values.T
        axes.plot(x, y, color=its.colour, linestyle=its.dashes, label=f"robot {robot}")
        axes.plot(x[:1], y[:1], its.marker, color=its.colour, fillstyle="none")
        axes.plot(x[-1:], y[-1:], its.marker, color=its.colour)
    axes.set(xlabel="$x$ (m)", ylabel="$y$ (m)", aspect="equal")
    _finish(axes)
    return figure


def aggregation_positions(formation: str, store: Store) -> Figure:
    """Positions in time for three consensus gains (Figs. 5 and 13)."""

    def draw(axes: Axes, gathering: xr.Dataset, position: xr.DataArray, its: Look, label: str) -> None:
        axes.plot(gathering["time"], position, color=its.colour, linestyle=its.dashes, label=label)

    runs = {f"δ = {delta:g} N/m": phase(store[aggregation(formation, delta)], 0) for delta in AGGREGATION_GAINS}
    return _by_axis("position", runs, ("$x$ (m)", "$y$ (m)"), "time $t$ (s)", draw, height=0.6)


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

    def draw(axes: Axes, carried: xr.Dataset, velocity: xr.DataArray, its: Look, label: str) -> None:
        draw_band(axes, since_hand_off(carried), velocity, its.colour, its.dashes, label)

    runs = {f"{kind}, δ = 0": phase(store[PROBABLE.transport(formation, kind, 0.0)], 1) for kind in MATERIALS}
    labels = ("$v_x$ (m/s)", "$v_y$ (m/s)")
    return _by_axis("velocity", runs, labels, "time since hand-off $t$ (s)", draw, height=0.55)


def _by_axis(
    name: str, runs: dict[str, xr.Dataset], labels: tuple[str, str], time: str, draw: Draw, *, height: float
) -> Figure:
    """What every robot has along x and, below it, along y; a column a run.

    Args:
        name: of the variable.
        runs: by their titles.
        labels: of the two rows.
        time: what the time's axis is called.
        draw: draws one robot's line.
        height: of the figure, as a share of its width.
    """
    figure = Figure(figsize=(PAGE, height * PAGE), layout="constrained")
    panels = figure.subplots(2, len(runs), sharex=True, sharey="row")
    for column, (title, result) in enumerate(runs.items()):
        for row, axis in enumerate(("x", "y")):
            for robot, its in robot_looks(result).items():
                values = result[name].sel(robot=robot, axis=axis)
                draw(panels[row, column], result, values, its, f"robot {robot}")
            panels[row, 0].set_ylabel(labels[row])
        panels[0, column].set_title(title)
        panels[1, column].set_xlabel(time)
    legend(panels[0, -1])
    return figure


def tracking_errors(formation: str, store: Store) -> Figure:
    """Tracking error at each gain: the robot farthest off, and each robot at δ = 0 (Figs. 9 and 17)."""
    figure = Figure(figsize=(PAGE, 0.7 * PAGE), layout="constrained")
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
    single.set_title("δ = 0, each robot")
    gains.set_title("largest of all robots")
    gains.set_xlabel("time since hand-off $t$ (s)")
    for axes in (single, gains):
        axes.set_ylabel(r"$\|\varepsilon_i\|$ (cm)")
        _finish(axes)
    return figure


def relative_distance(store: Store) -> Figure:
    """Distance d12 at δ = 0 for both materials (Fig. 10)."""
    figure, axes = _panel("$d_{12}$ (m)", "time since hand-off $t$ (s)")
    for material, colour in COLOURS.items():
        carried = phase(store[PROBABLE.transport("line", material, 0.0)], 1)
        distance = carried["spring_length"].sel(spring="1-2")
        draw_band(axes, since_hand_off(carried), distance, colour, "-", material)
    _finish(axes)
    return figure


def consensus_errors(formation: str, store: Store) -> Figure:
    """Consensus error of the robot farthest off for both materials and three gains (Figs. 11 and 18)."""
    figure, axes = _panel(f"{FARTHEST} (cm), within each half second", "time since hand-off $t$ (s)")
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
    figure = Figure(figsize=(PAGE, 0.4 * PAGE), layout="constrained")
    for axes, reading in zip(figure.subplots(1, len(READINGS), sharey=True), READINGS.values(), strict=True):
        local = reading.transport("quadrilateral", "rubber", 0.0)
        runs = {"local LQR": local} | {name: reading.topology(name) for name in TOPOLOGIES}
        errors = [100 * store.measured(run).consensus_error_m for run in runs.values()]
        drawn = axes.bar(list(runs), errors, color=["0.6"] + [PALETTE[0]] * len(TOPOLOGIES))
        axes.bar_label(drawn, fmt="%.2f")
        axes.margins(y=0.1)
        axes.set_title(reading.title)
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


def _panel(label: str, time: str = "time $t$ (s)") -> tuple[Figure, Axes]:
    figure = Figure(figsize=(PAGE, 0.45 * PAGE), layout="constrained")
    axes = figure.subplots()
    axes.set(xlabel=time, ylabel=label)
    return figure, axes


def _finish(axes: Axes) -> None:
    legend(axes)
