"""Error against channels, drawn: every graph of the study."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drake_formation.formation.rigidity import rigid_rank
from drake_formation.paper.bandwidth.findings import Findings
from drake_formation.paper.bandwidth.study import Tried
from drake_formation.viz.figures.looks import COLOURS
from drake_formation.viz.figures.panels import INCH, WIDTHS


def by_channels(found: Findings, numbers: Sequence[int]) -> Figure:
    """Largest consensus error of every graph against its channels, a panel for each number of robots."""
    figure = Figure(figsize=(WIDTHS["page"] / INCH, 115 / INCH), layout="constrained")
    columns = -(-len(numbers) // 2)
    panels = figure.subplots(2, columns, squeeze=False)
    for axes, robots in zip(panels.flat, numbers, strict=False):
        _panel(axes, robots, found.of(robots))
    for axes in panels[:, 0]:
        axes.set_ylabel(r"largest $\|e_i\|$ (cm)")
    for axes in panels[-1]:
        axes.set_xlabel("channels")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    return figure


def _panel(axes: Axes, robots: int, found: Findings) -> None:
    needed, fewest, most = 2 * rigid_rank(robots), 2 * (robots - 1), robots * (robots - 1)
    axes.axvspan(0, needed - 1, color="0.95", zorder=0, linewidth=0)
    alone = found.alone[robots].errors["hookean"]
    axes.axhline(alone, color="0.3", linestyle="--", linewidth=1, label="local LQR alone")
    _points(axes, found.flexible, "hookean", "o", COLOURS[1], "on distances, flexible")
    _points(axes, found.braced, "hookean", "o", COLOURS[0], "on distances, rigid")
    _points(axes, found.minimally_rigid, "hookean", "D", "black", "on distances, minimally rigid")
    _points(axes, found.connected, "linear", "x", COLOURS[2], "on displacements, connected")
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_xticks(range(fewest, most + 1, 2 * -(-(most - fewest) // 16)))  # channels come in pairs
    axes.set_xlim(fewest - 1, most + 1)
    axes.set_title(f"{robots} robots: rigid with {needed} channels or more", fontsize="small")


def _points(axes: Axes, tried: list[Tried], law: str, marker: str, colour: str, label: str) -> None:
    channels, errors = [one.channels for one in tried], [one.errors[law] for one in tried]
    axes.scatter(channels, errors, s=10, marker=marker, color=colour, alpha=0.7, linewidths=0.8, label=label, zorder=3)
