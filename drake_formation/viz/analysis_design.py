"""Figure of a design: consensus error against effort."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from drake_formation.analysis.gains.quadratic_cost import HAND_OFF_ERROR, HandOffCost
from drake_formation.analysis.gains.tuning import pareto, weight_of
from drake_formation.analysis.linear.linearization import LinearFormation

DECADES, A_DECADE = 4, 3
"""Decades of δ along the curves, and designs in each; the gains of one a decade are written beside it."""


def pareto_front(formation: LinearFormation, *, hand_off_error_m: float = HAND_OFF_ERROR) -> Figure:
    """The front of consensus error against effort, and where δ alone and the scenario's own gains lie.

    Args:
        formation: the linearized loop.
        hand_off_error_m: root mean square of every robot's hand-off error (m).

    Raises:
        IllPosedError: one robot, or an unstable loop.
    """
    largest = max(2 * formation.delta, 2e4)
    deltas = np.geomspace(10**-DECADES * largest, largest, DECADES * A_DECADE + 1)
    front = pareto(formation, [weight_of(formation, delta) for delta in deltas], hand_off_error_m=hand_off_error_m)
    costs = HandOffCost(formation, hand_off_error_m)
    figure = Figure(figsize=(8, 5.5), layout="constrained")
    axes = figure.subplots()
    undamped = np.array([costs.error_and_effort(delta, 0.0) for delta in deltas])
    axes.loglog(undamped[:, 1], undamped[:, 0], color="tab:orange", linestyle="--", label="δ alone (N/m), δ_v = 0")
    axes.loglog(
        [t.effort for t in front], [t.error for t in front], "o-", markersize=4, label="δ (N/m) and δ_v (N s/m) tuned"
    )
    for delta, (error, effort) in list(zip(deltas, undamped, strict=True))[::A_DECADE]:
        _name(axes, effort, error, f"δ = {_short(delta)}")
    for tuned in front[::A_DECADE]:
        _name(axes, tuned.effort, tuned.error, f"δ = {_short(tuned.delta)}, δ_v = {_short(tuned.delta_v)}")
    error, effort = costs.error_and_effort(formation.delta, formation.delta_v)
    axes.loglog([effort], [error], "k*", markersize=12, label="gains of the scenario")
    axes.set(
        xlabel="effort, mean ∫‖u‖² dt (N² s)",
        ylabel="consensus error, mean ∫‖e‖² dt (m² s)",
        title=f"{formation.scenario.name}: error against effort, {100 * hand_off_error_m:g} cm rms at the hand-off",
    )
    axes.margins(0.1, 0.15)
    axes.grid(alpha=0.3, which="major")
    axes.legend(loc="lower left", fontsize="small", frameon=False)
    return figure


def _short(gain: float) -> str:
    """A gain to two digits, without an exponent where that is short."""
    return f"{float(f'{gain:.2g}'):g}"


def _name(axes: Axes, x: float, y: float, text: str) -> None:
    axes.annotate(text, (x, y), textcoords="offset points", xytext=(6, 5), fontsize="x-small")
