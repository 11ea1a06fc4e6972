"""The s-curve of Fig. 19, and the set point beside planned references: how the published numbers come out."""

from typing import Any

from matplotlib.figure import Figure

from drake_formation.markdown import markdown_table
from drake_formation.paper.figures.curves import PAGE, phase, since_hand_off
from drake_formation.paper.figures.paths import draw_transport
from drake_formation.paper.runs import transport
from drake_formation.paper.store import Store
from drake_formation.scenario import Scenario, load_scenario, with_overrides
from drake_formation.vectors import length
from drake_formation.viz.figures import snapshot_times
from drake_formation.viz.obstacles import draw_obstacles

REFERENCES: dict[str, dict[str, Any]] = {
    "set point": {},
    "minimum jerk": {"transport.reference": {"kind": "minimum_jerk"}},
    "minimum jerk, feed-forward": {"transport.reference": {"kind": "minimum_jerk"}, "tracking.feed_forward": True},
    "plan around known obstacles": {"transport.reference": {"kind": "potential_field"}},
}
"""References of the comparison, as overrides."""


def referenced(name: str) -> Scenario:
    """The quadrilateral with rubber and without consensus, following a reference."""
    return with_overrides(transport("quadrilateral", "rubber", 0.0), REFERENCES[name])


def trajectory_runs() -> list[Scenario]:
    """The runs of the comparison."""
    return [referenced(name) for name in REFERENCES]


def comparison(store: Store) -> str:
    """Peak force, errors and lag by reference, as a Markdown table."""
    rows = []
    for name in REFERENCES:
        result = store[referenced(name)]
        figures = store.measured(referenced(name))
        lag = float(length(phase(result, 1)["tracking_error"]).max())
        errors = [100 * max(figures.tracking_error_m), 100 * figures.consensus_error_m]
        rows.append([name, f"{figures.peak_force_n:.1f}", f"{errors[0]:.1f}", f"{errors[1]:.2f}", f"{lag:.2f}"])
    heading = ["reference", "peak force (N)", "largest ‖ε‖ (cm)", "largest ‖e‖ (cm)", "largest lag (m)"]
    return markdown_table(heading, rows)


def s_curve() -> Scenario:
    """The shipped s-curve."""
    return load_scenario("s_curve")


def s_curve_figure(store: Store) -> Figure:
    """Paths along the s-curve, and the distances between the robots (Fig. 19)."""
    carried = phase(store[s_curve()], 1)
    figure = Figure(figsize=(PAGE, 0.7 * PAGE), layout="constrained")
    plane, springs = figure.subplots(2, height_ratios=[2, 1])
    draw_transport(plane, carried)
    draw_obstacles(plane, carried, snapshot_times(carried))
    plane.set(xlabel="$x$ (m)", ylabel="$y$ (m)")
    elongation = 100 * abs(carried["spring_length"] - carried["rest_length"]).max("spring")
    springs.plot(since_hand_off(carried), elongation)
    springs.set(xlabel="time since hand-off $t$ (s)", ylabel=r"largest $|d_{ij} - r_{ij}|$ (cm)")
    return figure
