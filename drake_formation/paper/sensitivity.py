"""How the results move with the parameters that are inferred, not published."""

from collections.abc import Callable
from typing import Any

from matplotlib.figure import Figure

from drake_formation.measuring import Metrics
from drake_formation.paper.runs import transport
from drake_formation.paper.store import Store
from drake_formation.scenario import Scenario, resolve, with_overrides
from drake_formation.viz.figures.panels import INCH, WIDTHS

DELTAS = (0.0, 1e4)

PARAMETERS: dict[str, tuple[float, ...]] = {
    "ρ0 (m)": (1.1, 1.2, 1.3, 1.4, 1.5),
    "η (N m²)": (22.0, 27.0, 31.56, 36.0, 41.0),
    "T_agg (s)": (40.0, 50.0, 60.0, 70.0, 80.0),
    "D (m)": (20.0, 21.25, 22.5, 23.75, 25.0),
}
"""Values of each inferred parameter, the study's own in the middle."""

MEASURES: dict[str, Callable[[Metrics], float]] = {
    "largest ‖ε‖ (cm)": lambda figures: 100 * max(figures.tracking_error_m),
    "largest ‖e‖ (cm)": lambda figures: 100 * figures.consensus_error_m,
    "peak |u| (N)": lambda figures: figures.peak_force_n,
}


def varied(parameter: str, value: float, delta: float) -> Scenario:
    """The line with rubber and one inferred parameter changed."""
    base = transport("line", "rubber", delta)
    x, y = resolve(base).centre
    overrides: dict[str, dict[str, Any]] = {
        "ρ0 (m)": {"avoidance.range": value},
        "η (N m²)": {"avoidance.gain": value},
        "T_agg (s)": {"aggregation.duration": value},
        "D (m)": {"transport.goal": [float(x) + value, float(y)]},
    }
    return with_overrides(base, overrides[parameter])


def sensitivity_runs() -> list[Scenario]:
    """The runs of the figure."""
    return [
        varied(parameter, value, delta)
        for parameter, values in PARAMETERS.items()
        for value in values
        for delta in DELTAS
    ]


def sensitivity(store: Store) -> Figure:
    """ε, e and |u| over each inferred parameter, the others as in the study."""
    figure = Figure(figsize=(WIDTHS["page"] / INCH, 105 / INCH), layout="constrained")
    panels = figure.subplots(len(MEASURES), len(PARAMETERS), sharex="col", sharey="row")
    for column, (parameter, values) in enumerate(PARAMETERS.items()):
        for delta in DELTAS:
            found = [measured(store, parameter, value, delta) for value in values]
            for row, measure in enumerate(MEASURES.values()):
                series = [measure(figures) for figures in found]
                panels[row, column].plot(values, series, "o-", markersize=4, label=f"δ = {delta:g}")
        for axes in panels[:, column]:
            axes.axvline(values[len(values) // 2], color="0.7", linewidth=0.8, zorder=0)
        panels[-1, column].set_xlabel(parameter)
    for axes, label in zip(panels[:, 0], MEASURES, strict=True):
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0)
    panels[0, 0].legend(fontsize="small", frameon=False)
    return figure


def measured(store: Store, parameter: str, value: float, delta: float) -> Metrics:
    """Metrics of one run of the figure."""
    return store.measured(varied(parameter, value, delta))
