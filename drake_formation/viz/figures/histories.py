"""What changed over time: errors, spring lengths and forces, from the hand-off on."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import NDArray

from drake_formation.viz.figures.envelope import draw_band
from drake_formation.viz.figures.events import mark_events
from drake_formation.viz.figures.looks import Look, looks_of, robot_looks, spring_looks
from drake_formation.viz.figures.panels import Width, drawing, height, legend
from drake_formation.viz.figures.quantities import CONSENSUS_ERROR, ELONGATION, FORCES, TRACKING_ERROR, Quantity
from drake_formation.viz.figures.results import Results, labelled, transport
from drake_formation.viz.figures.scales import scale

Array = NDArray[np.float64]

OPACITY = 0.7
"""Of all bands together, about; what is behind them is still seen."""
MOST_SPRINGS = 10
"""More springs than this are not named one by one."""


def tracking_error(results: Results, axes: Axes | None = None, *, whole: bool = False, width: Width = "page") -> Axes:
    """Deviation of every robot from the obstacle-free response (paper, Fig. 9).

    What is faster than a pixel is a band, along whose upper edge the line goes. The scale is logarithmic where values
    range over decades. Of several results the largest of any robot is drawn, a line each.

    Args:
        results: one result, or several by name.
        axes: where to draw; a figure of their own if not given.
        whole: from the start on, not from the hand-off.
        width: of that figure.
    """
    return _one(TRACKING_ERROR, results, axes, whole, width)


def consensus_error(results: Results, axes: Axes | None = None, *, whole: bool = False, width: Width = "page") -> Axes:
    """Consensus error of every robot (paper, Figs. 6 and 11), drawn as :func:`tracking_error` is."""
    return _one(CONSENSUS_ERROR, results, axes, whole, width)


def spring_lengths(results: Results, axes: Axes | None = None, *, whole: bool = False, width: Width = "page") -> Axes:
    """Elongation of every spring while it holds its robots (paper, Fig. 10, about the length at rest).

    Drawn as :func:`tracking_error` is, but that a band has lines along both edges, and decades both signs.
    """
    return _one(ELONGATION, results, axes, whole, width)


def control_forces(
    results: Results, axes: Sequence[Axes] | None = None, *, whole: bool = False, width: Width = "page"
) -> list[Axes]:
    """Control force of every robot and its three parts (paper, Eq. 8; springs excluded).

    Drawn as :func:`tracking_error` is, in four axes.
    """
    named = labelled(results)
    title = _title(named, "control forces")
    with drawing(axes, [height(width, alone=False)] * len(FORCES), width, title=title, sharex=True) as panels:
        for panel, quantity in zip(panels, FORCES, strict=True):
            draw_quantity(panel, quantity, named, whole=whole)
        for panel in panels[:-1]:
            panel.set_xlabel("")
        legend(panels[0])
    return panels


def draw_quantity(axes: Axes, quantity: Quantity, named: dict[str, xr.Dataset], *, whole: bool = False) -> None:
    """Draw a quantity over time: of every robot or spring or, of several results, the largest.

    Args:
        axes: where.
        quantity: what.
        named: results by name.
        whole: from the start on, not from the hand-off.
    """
    shown = {name: result if whole else transport(result) for name, result in named.items()}
    if len(shown) > 1:
        draw_lines(axes, [largest(quantity, shown[name], its, name) for name, its in looks_of(shown).items()])
        axes.set_ylabel(quantity.largest_label)
        return
    (result,) = shown.values()
    draw_lines(axes, _each(quantity, result), signed=quantity.signed)
    axes.set_ylabel(quantity.label)
    mark_events(axes, result)
    _mark_aggregation(axes, result)


@dataclass(frozen=True)
class Line:
    """One of the lines over time.

    Attributes:
        time: sample times (s), shape (samples,).
        values: then, in the unit of the axes, shape (samples,).
        look: how it is drawn.
        label: what the legend calls it, if anything.
    """

    time: Array
    values: Array
    look: Look
    label: str | None


def largest(quantity: Quantity, result: xr.Dataset, look: Look, label: str | None) -> Line:
    """The line of the largest magnitude that a quantity has in a result."""
    values = abs(quantity.of(result)).max(quantity.over).values
    return Line(result["time"].values, values, look, label)


def draw_lines(axes: Axes, lines: Sequence[Line], *, signed: bool = False) -> None:
    """Draw lines over time, what is faster than a pixel as bands, on the scale that shows them.

    Args:
        axes: where.
        lines: what.
        signed: whether they are no magnitudes.
    """
    for line in lines:
        draw_band(
            axes, line.time, line.values, line.look.colour, line.look.dashes, line.label,
            magnitude=not signed, opacity=OPACITY / (1 + len(lines)),
        )  # fmt: skip
    scale(axes, [(line.time, line.values) for line in lines], signed=signed)
    axes.set_xlabel("time $t$ (s)")
    ends = [time for line in lines for time in line.time[[0, -1]]]
    if ends and max(ends) > min(ends):
        axes.set_xlim(min(ends), max(ends))


def _each(quantity: Quantity, result: xr.Dataset) -> list[Line]:
    """A line for every robot, or spring."""
    series = quantity.of(result).transpose(quantity.over, "time").values
    if quantity.over == "robot":
        named = {f"robot {robot}": its for robot, its in robot_looks(result).items()}
    else:
        named = spring_looks([str(spring) for spring in result["spring"].values])
        rests = result["rest_length"].values.tolist()
        named = {f"{name}: {rest:.3g} m at rest": its for (name, its), rest in zip(named.items(), rests, strict=True)}
    few = quantity.over == "robot" or len(named) <= MOST_SPRINGS
    return [
        Line(result["time"].values, values, its, label if few else None)
        for values, (label, its) in zip(series, named.items(), strict=True)
    ]


def _one(quantity: Quantity, results: Results, axes: Axes | None, whole: bool, width: Width) -> Axes:
    named = labelled(results)
    count = max(result.sizes["spring"] for result in named.values())
    unnamed = f", all {count}" if quantity.over == "spring" and count > MOST_SPRINGS else ""
    with drawing(axes, [height(width)], width, title=_title(named, quantity.subject + unnamed)) as (panel,):
        draw_quantity(panel, quantity, named, whole=whole)
        legend(panel)
    return panel


def _title(named: dict[str, xr.Dataset], subject: str) -> str:
    """What is drawn, and of which result where it is one."""
    return subject if len(named) > 1 else f"{next(iter(named.values())).attrs['title']}: {subject}"


def _mark_aggregation(axes: Axes, result: xr.Dataset) -> None:
    """Shade what is before the hand-off, if it is shown."""
    carried = result["phase"].values == 1
    if carried.any() and not carried[0]:
        times = result["time"].values
        axes.axvspan(times[0], times[carried][0], color="0.93", linewidth=0, zorder=0, label="aggregation")
