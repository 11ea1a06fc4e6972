"""Figure of the delay margin: how it falls with δ, what δ_v buys, and how the two kinds of delay differ."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.lines import Line2D
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.network.delay_margin import Delayed, shortest_delay
from drake_formation.viz.figures.panels import Width, drawing, height, legend

Array = NDArray[np.float64]

VELOCITY_GAINS = (0.0, 100.0, 1000.0)
"""δ_v drawn beside the scenario's own (N s/m)."""

SMALLEST_DELTA = 1.0
"""Where δ begins (N/m): about the local LQR's own stiffness."""

LARGEST_DELTA = 2e4
"""δ goes at least to the largest of the paper's gains (N/m)."""

COARSE, FINE = 5, 20
"""So many values of δ are always taken; between them as many as a curve needs, down to this part of its width."""
MANY = 8
"""With so many robots a margin takes long: fewer curves are drawn, and in larger steps."""
FINE_OF_MANY, VELOCITY_GAINS_OF_MANY = 8, (0.0, 1000.0)

STRAIGHT = 0.05
"""A curve is straight where its middle is the mean of its ends to this share, on logarithmic axes."""

STYLES: dict[Delayed, Literal["-", "--"]] = {"neighbour": "--", "relative": "-"}
LABELS: dict[Delayed, str] = {"neighbour": "neighbours' states late", "relative": "the whole difference late"}


def delay_margin_against_delta(
    formation: LinearFormation,
    axes: Axes | None = None,
    *,
    deltas: Sequence[float] | None = None,
    velocity_gains: Sequence[float] | None = None,
    width: Width = "page",
) -> Axes:
    """The delay margin against δ, for delayed neighbours and for the whole difference delayed, at several δ_v.

    Where a line is missing every delay is tolerated; where it jumps, another mode has become the critical one. Rings
    mark the scenario's own gains.

    Args:
        formation: the linearized closed loop.
        axes: where to draw; a figure of their own if not given.
        deltas: consensus gains δ (N/m), positive and ascending; if not given, as many as each curve needs.
        velocity_gains: velocity consensus gains δ_v (N s/m).
        width: of that figure.

    Raises:
        IllPosedError: there is one robot, or the loop is unstable without delay.
    """
    if velocity_gains is None:
        usual = VELOCITY_GAINS if formation.robots < MANY else VELOCITY_GAINS_OF_MANY
        velocity_gains = sorted({*usual, formation.delta_v})
    colours = [to_hex(colormaps["viridis"](shade)) for shade in np.linspace(0, 0.85, len(velocity_gains))]
    largest = max(LARGEST_DELTA, 2 * formation.delta)
    title = f"{formation.scenario.name}: delay margin"
    # Many small matrices: threads of the linear algebra would wait for one another most of the time.
    with drawing(axes, [height(width)], width, title=title) as (panel,), threadpool_limits(limits=1, user_api="blas"):
        for delta_v, colour in zip(velocity_gains, colours, strict=True):
            for of in get_args(Delayed):
                if deltas is None:
                    drawn, delays = curve(formation, of, delta_v, SMALLEST_DELTA, largest)
                else:
                    drawn, delays = np.array(deltas), margins(formation, of, deltas, delta_v)
                panel.plot(drawn, delays, STYLES[of], color=colour)
        _mark_own(panel, formation)
        panel.set(xscale="log", yscale="log", xlabel=r"consensus gain $\delta$ (N/m)")
        panel.set_ylabel(r"delay margin $\tau^*$ (ms)")
        panel.set_xlim(*((SMALLEST_DELTA, largest) if deltas is None else (deltas[0], deltas[-1])))
        _legend(panel, velocity_gains, colours)
    return panel


def curve(formation: LinearFormation, of: Delayed, delta_v: float, low: float, high: float) -> tuple[Array, Array]:
    """Values of δ (N/m) from low to high, and delay margins (ms) there; close together where the curve bends.

    Every margin is exact; where it is straight on logarithmic axes few values stand for it.
    """
    found: dict[float, float] = {}
    fine = FINE if formation.robots < MANY else FINE_OF_MANY

    def at(place: float) -> float:
        """Logarithm of the margin at a place from 0 (low) to 1 (high)."""
        if place not in found:
            found[place] = float(margins(formation, of, [low * (high / low) ** place], delta_v)[0])
        return float(np.log(found[place]))

    pending = list(pairwise(np.linspace(0.0, 1.0, COARSE).tolist()))
    while pending:
        left, right = pending.pop()
        middle = (left + right) / 2
        ends, between = np.array([at(left), at(right)]), at(middle)
        missing = np.isnan([*ends, between])
        straight = missing.all() if missing.any() else abs(between - ends.mean()) <= STRAIGHT
        if not straight and right - left > 1 / fine:
            pending += [(left, middle), (middle, right)]
    places = np.array(sorted(found))
    return low * (high / low) ** places, np.array([found[place] for place in places.tolist()])


def margins(formation: LinearFormation, of: Delayed, deltas: Sequence[float], delta_v: float) -> Array:
    """Delay margins (ms) for several δ (N/m); not a number where every delay is tolerated."""
    found = (shortest_delay(formation, of=of, delta=delta, delta_v=delta_v) for delta in deltas)
    return np.array([np.nan if each is None else 1e3 * each.delay for each in found])


def _mark_own(axes: Axes, formation: LinearFormation) -> None:
    if formation.delta == 0:
        return
    for of in get_args(Delayed):
        (own,) = margins(formation, of, [formation.delta], formation.delta_v)
        axes.plot([formation.delta], [own], "o", color="black", fillstyle="none", markersize=9, zorder=4)


def _legend(axes: Axes, velocity_gains: Sequence[float], colours: Sequence[str]) -> None:
    entries = [Line2D([], [], color="0.3", linestyle=STYLES[of], label=LABELS[of]) for of in get_args(Delayed)]
    for delta_v, colour in zip(velocity_gains, colours, strict=True):
        entries.append(Line2D([], [], color=colour, linewidth=4, label=rf"$\delta_v$ = {delta_v:g} N s/m"))
    if len(axes.lines) > 2 * len(velocity_gains):
        entries.append(
            Line2D([], [], color="black", marker="o", fillstyle="none", linestyle="", label="the scenario's gains")
        )
    legend(axes, entries, heading="a missing line: any delay is tolerated")
