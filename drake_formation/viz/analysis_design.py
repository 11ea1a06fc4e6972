"""Figure of a design: consensus error against effort."""

import numpy as np
from matplotlib.axes import Axes

from drake_formation.analysis.gains.quadratic_cost import HAND_OFF_ERROR, HandOffCost
from drake_formation.analysis.gains.tuning import pareto, weight_of
from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.viz.figures.looks import COLOURS
from drake_formation.viz.figures.panels import Width, drawing, height, legend

DECADES, A_DECADE = 4, 3
"""Decades of δ along the curves, and designs in each; the gains of one a decade are written beside it."""


def pareto_front(
    formation: LinearFormation,
    axes: Axes | None = None,
    *,
    hand_off_error_m: float = HAND_OFF_ERROR,
    width: Width = "page",
) -> Axes:
    """The front of consensus error against effort, and where δ alone and the scenario's own gains lie.

    Args:
        formation: the linearized loop.
        axes: where to draw; a figure of their own if not given.
        hand_off_error_m: root mean square of every robot's hand-off error (m).
        width: of that figure.

    Raises:
        IllPosedError: one robot, or an unstable loop.
    """
    largest = max(2 * formation.delta, 2e4)
    deltas = np.geomspace(10**-DECADES * largest, largest, DECADES * A_DECADE + 1)
    front = pareto(formation, [weight_of(formation, delta) for delta in deltas], hand_off_error_m=hand_off_error_m)
    costs = HandOffCost(formation, hand_off_error_m)
    undamped = np.array([costs.error_and_effort(delta, 0.0) for delta in deltas])
    own = costs.error_and_effort(formation.delta, formation.delta_v)
    title = f"{formation.scenario.name}: error against effort, {100 * hand_off_error_m:g} cm rms at the hand-off"
    with drawing(axes, [1.2 * height(width)], width, title=title) as (panel,):
        alone, both = r"$\delta$ alone (N/m), $\delta_v$ = 0", r"$\delta$ (N/m) and $\delta_v$ (N s/m) tuned"
        panel.loglog(undamped[:, 1], undamped[:, 0], color=COLOURS[1], linestyle="--", label=alone)
        panel.loglog([t.effort for t in front], [t.error for t in front], "o-", color=COLOURS[0], label=both)
        for delta, (error, effort) in list(zip(deltas, undamped, strict=True))[::A_DECADE]:
            _name(panel, effort, error, rf"$\delta$ = {_short(delta)}")
        for tuned in front[::A_DECADE]:
            gains = rf"$\delta$ = {_short(tuned.delta)}, $\delta_v$ = {_short(tuned.delta_v)}"
            _name(panel, tuned.effort, tuned.error, gains)
        panel.loglog([own[1]], [own[0]], "k*", markersize=10, label="gains of the scenario")
        panel.set_xlabel(r"effort, mean $\int \|u_i\|^2 \mathrm{d}t$ (N² s)")
        panel.set_ylabel(r"consensus error, mean $\int \|e_i\|^2 \mathrm{d}t$ (m² s)")
        panel.margins(0.1, 0.15)
        legend(panel, above=True)
    return panel


def _short(gain: float) -> str:
    """A gain to two digits, without an exponent where that is short."""
    return f"{float(f'{gain:.2g}'):g}"


def _name(axes: Axes, x: float, y: float, text: str) -> None:
    axes.annotate(text, (x, y), textcoords="offset points", xytext=(6, 5), fontsize="x-small")
