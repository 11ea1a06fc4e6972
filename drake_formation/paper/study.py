"""The parts of the study by name, in the order of the report."""

from collections.abc import Callable
from functools import partial

from matplotlib.figure import Figure

from drake_formation.diagram import build_diagram
from drake_formation.paper.bandwidth import answer as bandwidth
from drake_formation.paper.bandwidth.figure_23 import bandwidth_runs
from drake_formation.paper.figures import curves, paths, schematics
from drake_formation.paper.provenance import provenance_part
from drake_formation.paper.readings.agreement import agreement_part, table_part
from drake_formation.paper.readings.explanations import explanations_part
from drake_formation.paper.readings.rivals import rivals_part
from drake_formation.paper.readings.two_readings import PROBABLE, READINGS
from drake_formation.paper.readings.worth import hold_out_part, ingredients_part
from drake_formation.paper.runs import AGGREGATION_GAINS, CASES, MATERIALS, TOPOLOGIES, aggregation
from drake_formation.paper.section import Part, Runs, Section, figure, no_runs, picture
from drake_formation.paper.sensitivity import sensitivity, sensitivity_runs
from drake_formation.paper.store import Store
from drake_formation.paper.trajectories import comparison, s_curve, s_curve_figure, trajectory_runs
from drake_formation.paper.verdicts.claims import claims_part
from drake_formation.scenario import Scenario, load_scenario


def _block_diagram(name: str, title: str, subsystem: str | None) -> Part:
    def make(_store: Store) -> Section:
        from drake_formation.viz.graphviz import write_diagram

        diagram = build_diagram(load_scenario("line"))
        shown = diagram.GetSubsystemByName(subsystem) if subsystem else diagram
        return Section(title=title, pictures={name: lambda path: write_diagram(shown, path)})

    return Part(make=make)


def _trajectories(store: Store) -> Section:
    return Section(
        title="References",
        text=(
            "The paper speaks of a planned reference, but its peak force at δ = 0 is K_l times the distance to the "
            "goal: a set point. The quadrilateral with rubber, δ = 0, as printed, by reference:\n\n" + comparison(store)
        ),
    )


def _sensitivity(store: Store) -> Section:
    return Section(
        title="Sensitivity to the inferred parameters",
        text=(
            "The line with rubber, as printed; one inferred parameter varied at a time, the study's own value marked. "
            "What moves here rests on the inference."
        ),
        pictures={"sensitivity": picture(sensitivity, store)},
    )


def _bandwidth(store: Store) -> Section:
    return Section(
        title="What is the minimum bandwidth?",
        text=bandwidth.answer(store),
        pictures={"bandwidth": picture(lambda _store: bandwidth.figure(), store)},
    )


def _aggregations(formation: str) -> list[Scenario]:
    return [aggregation(formation, delta) for delta in AGGREGATION_GAINS]


def _local(formation: str) -> list[Scenario]:
    return [PROBABLE.transport(formation, material, 0.0) for material in MATERIALS]


def _all(formation: str) -> list[Scenario]:
    return [PROBABLE.transport(*case) for case in CASES if case[0] == formation]


def _bars() -> list[Scenario]:
    return [
        run
        for reading in READINGS.values()
        for run in (reading.transport("quadrilateral", "rubber", 0.0), *map(reading.topology, TOPOLOGIES))
    ]


Kind = tuple[str, Callable[[str], list[Scenario]], Callable[[str, Store], Figure]]

_KINDS: dict[str, Kind] = {
    "gather": ("Aggregation", _aggregations, curves.aggregation_paths),
    "positions": ("Aggregation for three consensus gains", _aggregations, curves.aggregation_positions),
    "agreement": ("Consensus error during aggregation", _aggregations, curves.aggregation_errors),
    "paths": ("Transport", _all, paths.transport_paths),
    "velocities": ("Velocities", _local, curves.velocities),
    "tracking": ("Tracking error", _all, curves.tracking_errors),
    "consensus": ("Consensus error", _all, curves.consensus_errors),
}
"""Figures that the paper shows alike for several formations: title, runs and what draws them."""

_OF_TRANSPORT = f"{PROBABLE.title.capitalize()}."


def _alike(formation: str, numbers: dict[str, int]) -> dict[str, Part]:
    parts = {}
    for kind, number in numbers.items():
        title, runs, draw = _KINDS[kind]
        text = "" if runs is _aggregations else _OF_TRANSPORT
        parts[f"fig{number}"] = _figure(
            number, f"{title}, {formation}", partial(draw, formation), partial(runs, formation), text
        )
    return parts


def _figure(number: int, title: str, draw: Callable[[Store], Figure], runs: Runs = no_runs, text: str = "") -> Part:
    return figure(f"fig{number}", f"Figure {number}. {title}", draw, runs=runs, text=text)


def _figures() -> dict[str, Part]:
    all_kinds = ("gather", "positions", "agreement", "paths", "velocities", "tracking")
    drawn = {
        "fig1": _figure(1, "Mass-spring model", lambda _store: schematics.mass_spring_model()),
        "fig2": _block_diagram("fig2", "Figure 2. The whole control system", None),
        "fig3": _block_diagram("fig3", "Figure 3. One robot", "robot_1"),
        **_alike("line", {**dict(zip(all_kinds, range(4, 10), strict=True)), "consensus": 11}),
        "fig10": _figure(
            10, "Distance d12 at δ = 0, line", curves.relative_distance, partial(_local, "line"), _OF_TRANSPORT
        ),
        **_alike("quadrilateral", dict(zip([*all_kinds, "consensus"], range(12, 19), strict=True))),
        "fig19": _figure(19, "An s-curve with four robots", s_curve_figure, lambda: [s_curve()]),
        "fig20": _figure(20, "The three formations", lambda _store: schematics.formations()),
        **_alike("octagon", {"paths": 21}),
        "fig22": _figure(22, "Communication topologies", lambda _store: schematics.topologies()),
        "fig23": figure("fig23", "Figure 23. Consensus error by topology", curves.topology_bars, measured=_bars),
    }
    return dict(sorted(drawn.items(), key=lambda item: int(item[0].removeprefix("fig"))))


_TABLES = {
    "table1": "Table 1. Stiffness of the transport objects",
    "table2": "Table 2. Tracking error of each robot, line",
    "table3": "Table 3. Consensus error and control input, line",
    "table4": "Table 4. Tracking error of all robots together, quadrilateral",
    "table5": "Table 5. Consensus error and control input, quadrilateral",
    "table6": "Table 6. Consensus error and control input, octagon",
}

PARTS: dict[str, Part] = {
    "parameters": provenance_part(),
    "readings": agreement_part(),
    **{name: table_part(name, title) for name, title in _TABLES.items()},
    "claims": claims_part(),
    "ingredients": ingredients_part(),
    "fit": hold_out_part(),
    "alternatives": rivals_part(),
    "explanations": explanations_part(),
    "trajectories": Part(make=_trajectories, runs=trajectory_runs),
    "bandwidth": Part(make=_bandwidth, measured=bandwidth_runs),
    "sensitivity": Part(make=_sensitivity, measured=sensitivity_runs),
    **_figures(),
}
"""Every part of the study by name, in the order of the report."""
