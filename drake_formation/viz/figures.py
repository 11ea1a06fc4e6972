"""Figures of a run: paths, errors, spring lengths and forces, as the paper shows them."""

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from drake_formation.vectors import length
from drake_formation.viz.events import draw_events, mark_events
from drake_formation.viz.obstacles import draw_obstacles

SNAPSHOTS = 7
"""Formation snapshots drawn along the way, hand-off and end included."""

SPRING_COLOUR = "0.6"


def paths(result: xr.Dataset) -> Figure:
    """Paths in the plane with obstacles and snapshots of the formation (paper, Figs. 4 and 7)."""
    figure = Figure(layout="constrained")
    axes = figure.subplots()
    carried = result["phase"].values == 1
    position = result["position"]
    for robot, colour in robot_colours(result).items():
        x, y = position.sel(robot=robot).values.T
        axes.plot(x[~carried], y[~carried], color=colour, linewidth=0.9, linestyle=":")
        axes.plot(x[:1], y[:1], "s", color=colour, markersize=4.5)
        axes.plot(x[carried], y[carried], color=colour, linewidth=1.4, label=f"robot {robot}")
    draw_obstacles(axes, result, snapshot_times(result))
    draw_events(axes, result)
    for time in snapshot_times(result):
        draw_formation(axes, result.sel(time=time))
    axes.set(xlabel="x (m)", ylabel="y (m)", title=_title(result, "paths"))
    axes.grid(alpha=0.3)
    axes.margins(0.02, 0.05)
    _fit_to_plane(figure, axes)
    if not carried.all():
        axes.plot([], [], "s:", color="0.4", linewidth=0.9, markersize=4.5, label="aggregation")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small", frameon=False)
    return figure


def tracking_error(result: xr.Dataset) -> Figure:
    """Deviation of every robot from the obstacle-free response (paper, Fig. 9)."""
    return _history(
        result, length(result["deviation"]) * 100, "tracking error ‖ε‖ (cm)", "tracking error", transport_only=True
    )


def consensus_error(result: xr.Dataset) -> Figure:
    """Consensus error of every robot on a logarithmic scale (paper, Figs. 6 and 11)."""
    error = length(result["consensus_error"])
    figure = _history(result, error, "consensus error ‖e‖ (m)", "consensus error")
    axes = figure.axes[0]
    if not bool((error > 0).any()):
        axes.set_ylim(0.0, 1e-6)
        return figure
    top = max(float(axes.dataLim.y1), 1e-6)
    axes.set_yscale("log")
    # A zero crossing dives as deep as a sample happens to hit it; six decades are enough to see anything.
    axes.set_ylim(max(axes.get_ylim()[0], top * 1e-6), top * 2)
    return figure


def spring_lengths(result: xr.Dataset) -> Figure:
    """Elongation of every spring (paper, Fig. 10, relative to the length at rest)."""
    acting = result["acting"] == 1 if "acting" in result else True
    elongation = (result["spring_length"] - result["rest_length"]).where((result["phase"] == 1) & acting) * 100
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    many = result.sizes["spring"] > 10
    for k, spring in enumerate(result["spring"].values):
        axes.plot(
            result["time"],
            elongation.sel(spring=spring),
            color=colormaps["viridis"](k / max(result.sizes["spring"] - 1, 1)),
            linewidth=1,
            label=None if many else f"{spring}: {float(result['rest_length'].sel(spring=spring)):.3g} m at rest",
        )
    axes.set(xlabel="time (s)", ylabel="spring elongation d − r (cm)", title=_title(result, "springs"))
    mark_transport(axes, result, only=True)
    if many:
        axes.set_title(f"{_title(result, 'springs')}, all {result.sizes['spring']}")
    elif result.sizes["spring"]:
        axes.legend(fontsize="small", frameon=False)
    return figure


def control_forces(result: xr.Dataset) -> Figure:
    """Control force of every robot and its three parts (paper, Eq. 8; springs excluded)."""
    parts = {
        "control_force": "total ‖u‖ (N)",
        "tracking_force": "local LQR ‖u_l‖ (N)",
        "consensus_force": "consensus ‖u_g‖ (N)",
        "avoidance_force": "avoidance (N)",
    }
    figure = Figure(figsize=(8, 8), layout="constrained")
    rows = list(figure.subplots(len(parts), sharex=True))
    for axes, (name, label) in zip(rows, parts.items(), strict=True):
        draw_history(axes, result, length(result[name]))
        axes.set_ylabel(label)
        axes.set_ylim(0.0, max(1.05 * axes.dataLim.y1, 1e-3))
        mark_transport(axes, result)
    rows[0].set_title(_title(result, "control forces"))
    rows[-1].set_xlabel("time (s)")
    _legend(rows[0])
    return figure


def robot_colours(result: xr.Dataset) -> dict[int, tuple[float, ...]]:
    """A colour for each robot, the same in every figure."""
    robots = [int(robot) for robot in result["robot"].values]
    if len(robots) <= 10:
        return {robot: colormaps["tab10"](k) for k, robot in enumerate(robots)}
    return {robot: colormaps["turbo"](k / (len(robots) - 1)) for k, robot in enumerate(robots)}


def snapshot_times(result: xr.Dataset) -> list[float]:
    """Times at which the formation has covered equal parts of the transport's path (s), first and last included."""
    transport = result.isel(time=result["phase"].values == 1)
    if transport.sizes["time"] < 2:
        return []
    centre = transport["position"].mean("robot").values
    covered = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(centre, axis=0), axis=-1))])
    marks = np.searchsorted(covered, np.linspace(0.0, covered[-1], SNAPSHOTS))
    return [float(time) for time in transport["time"].values[np.minimum(marks, len(covered) - 1)]]


def _history(
    result: xr.Dataset, series: xr.DataArray, label: str, subject: str, transport_only: bool = False
) -> Figure:
    figure = Figure(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    draw_history(axes, result, series)
    axes.set(xlabel="time (s)", ylabel=label, title=_title(result, subject))
    mark_transport(axes, result, only=transport_only)
    _legend(axes)
    return figure


def draw_history(axes: Axes, result: xr.Dataset, series: xr.DataArray) -> None:
    """Draw a series of every robot over time."""
    for k, (robot, colour) in enumerate(robot_colours(result).items()):
        # Later robots are dashed: two robots often do the same, and one line would hide the other.
        style = "-" if k % 2 == 0 else (k, (4, 3))
        axes.plot(result["time"], series.sel(robot=robot), color=colour, linestyle=style, linewidth=1.2, label=robot)


def mark_transport(axes: Axes, result: xr.Dataset, only: bool = False) -> None:
    """Grid, what happened, and where the object is carried."""
    axes.grid(alpha=0.3)
    mark_events(axes, result)
    times, carried = result["time"].values, result["phase"].values == 1
    if carried.sum() < 2:  # a run that ended at its hand-off has no transport to show
        return
    hand_off = times[carried][0]
    axes.set_xlim(hand_off if only else times[0], times[-1])
    if hand_off > times[0] and not only:
        axes.axvspan(times[0], hand_off, color="0.93", zorder=0)
        axes.text(hand_off, 0.96, " hand-off", transform=axes.get_xaxis_transform(), va="top", fontsize="small")


def _legend(axes: Axes) -> None:
    axes.legend(title="robot", fontsize="small", frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _fit_to_plane(figure: Figure, axes: Axes) -> None:
    """Give both axes one scale, and the figure the shape of what it shows."""
    axes.autoscale_view()
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    axes.set_aspect("equal")
    width = 11.0
    height = 0.8 * width * (top - bottom) / (right - left) + 1.0
    figure.set_size_inches(width, min(max(height, 3.0), width))


def draw_formation(axes: Axes, moment: xr.Dataset) -> None:
    """Draw robots, and the springs that hold them, in the plane at one time of a result."""
    acting = moment["spring"].values[moment["acting"].values == 1] if "acting" in moment else moment["spring"].values
    for spring in acting:
        ends = [int(robot) for robot in str(spring).split("-")]
        x, y = moment["position"].sel(robot=ends).values.T
        axes.plot(x, y, color=SPRING_COLOUR, linewidth=0.8, zorder=1)
    for robot, colour in robot_colours(moment).items():
        x, y = moment["position"].sel(robot=robot).values
        axes.plot([x], [y], "o", color=colour, markersize=4.5, markeredgecolor="white", markeredgewidth=0.5)
        if "robot_radius" in moment:
            radius = float(moment["robot_radius"].sel(robot=robot))
            axes.add_patch(Circle((x, y), radius, color=colour, alpha=0.2, linewidth=0))


def _title(result: xr.Dataset, subject: str) -> str:
    return f"{result.attrs['title']}: {subject}"
