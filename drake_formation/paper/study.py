"""The parts of the study by name: which runs each needs and what it makes of them."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from drake_formation.diagram import build_diagram
from drake_formation.markdown import markdown_table
from drake_formation.paper import curves, readings, schematics
from drake_formation.paper.bandwidth import answer as bandwidth
from drake_formation.paper.bandwidth.figure_23 import bandwidth_runs
from drake_formation.paper.claims import CLAIMS, claim_runs
from drake_formation.paper.fit import fit
from drake_formation.paper.published import PROVENANCE
from drake_formation.paper.runs import (
    AGGREGATION_GAINS,
    MATERIALS,
    TOPOLOGIES,
    aggregation,
    topology,
    transport,
    transports,
)
from drake_formation.paper.sensitivity import sensitivity, sensitivity_runs
from drake_formation.paper.store import Store
from drake_formation.paper.tables import Cell, table, table_runs
from drake_formation.paper.trajectories import comparison, s_curve, s_curve_figure, trajectory_runs
from drake_formation.scenario import Scenario, load_scenario
from drake_formation.viz.style import draw

Picture = Callable[[Path], None]
"""Draws itself to a PNG file."""


@dataclass(frozen=True, kw_only=True)
class Section:
    """A piece of the report.

    Attributes:
        title: its heading.
        text: Markdown under the heading.
        pictures: by file name without suffix.
        cells: rows for ``tables.csv``.
    """

    title: str
    text: str = ""
    pictures: dict[str, Picture] = field(default_factory=dict)
    cells: list[Cell] = field(default_factory=list)


@dataclass(frozen=True, kw_only=True)
class Part:
    """A part of the study.

    Attributes:
        runs: the scenarios it needs, known beforehand.
        make: the section, from the store.
    """

    runs: Callable[[], list[Scenario]]
    make: Callable[[Store], Section]


def _no_runs() -> list[Scenario]:
    return []


def _provenance(_store: Store) -> Section:
    return Section(
        title="Parameters and where they come from",
        text=markdown_table(["parameter", "value", "provenance"], PROVENANCE),
    )


def _table(name: str, title: str, store: Store) -> Section:
    cells = table(name, store)
    reasons = list(dict.fromkeys(cell.reason for cell in cells if not cell.agrees))
    rows = [
        [
            cell.row,
            cell.column,
            f"{cell.published:g}",
            f"{cell.ours:.4g}",
            f"{cell.difference:+.3g}",
            cell.unit,
            "agrees" if cell.agrees else f"differs ({reasons.index(cell.reason) + 1})",
        ]
        for cell in cells
    ]
    notes = [f"{number}. {reason}." for number, reason in enumerate(reasons, start=1)]
    heading = ["row", "column", "published", "ours", "difference", "unit", ""]
    return Section(title=title, text="\n".join([markdown_table(heading, rows), "", *notes]).rstrip(), cells=cells)


def _figure(name: str, title: str, make: Callable[[Store], Figure], store: Store) -> Section:
    return Section(title=title, pictures={name: partial(_save, partial(make, store))})


def _save(make: Callable[[], Figure], path: Path) -> None:
    draw(make, path, dpi=110)


def _block_diagram(name: str, title: str, subsystem: str | None, _store: Store) -> Section:
    from drake_formation.viz.graphviz import write_diagram

    diagram = build_diagram(load_scenario("line"))
    shown = diagram.GetSubsystemByName(subsystem) if subsystem else diagram
    return Section(title=title, pictures={name: lambda path: write_diagram(shown, path)})


def _claims(store: Store) -> Section:
    claims = [examine(store) for examine in CLAIMS]
    rows = [[claim.claim, f"**{claim.verdict}**", claim.evidence, claim.source] for claim in claims]
    return Section(title="Claims", text=markdown_table(["claim", "verdict", "what decides it", "source"], rows))


def _fit(store: Store) -> Section:
    found = fit(store)
    return Section(
        title="The fit",
        text=(
            f"η = {found.gain:.3f} N m² gives e = {100 * found.error:.3f} cm for the line with rubber at δ = 0 and "
            f"ρ0 = 1.3 m (published: {100 * found.target:g} cm), found in {found.runs} runs. The scenarios use 31.56. "
            "Nothing else is tuned."
        ),
    )


def _trajectories(store: Store) -> Section:
    return Section(
        title="References",
        text=(
            "The paper speaks of a planned reference, but its peak force at δ = 0 is K_l times the distance to the "
            "goal: a set "
            "point. The quadrilateral with rubber, δ = 0, by reference:\n\n" + comparison(store)
        ),
    )


def _readings(store: Store) -> Section:
    return Section(
        title="Readings",
        text=(
            "The paper says that an obstacle can only be detected by the nearest robot. Cells of the tables that "
            "agree when "
            "every robot within ρ0 feels an obstacle, and when only the nearest of them does; η is not fitted "
            "again:\n\n" + readings.comparison(store)
        ),
    )


def _sensitivity(store: Store) -> Section:
    return Section(
        title="Sensitivity to the inferred parameters",
        text=(
            "The line with rubber; one inferred parameter varied at a time, the study's own value marked. What moves "
            "here rests on the inference."
        ),
        pictures={"sensitivity": partial(_save, partial(sensitivity, store))},
    )


def _bandwidth(store: Store) -> Section:
    return Section(
        title="What is the minimum bandwidth?",
        text=bandwidth.answer(store),
        pictures={"bandwidth": partial(_save, bandwidth.figure)},
    )


def _aggregations(formation: str) -> list[Scenario]:
    return [aggregation(formation, delta) for delta in AGGREGATION_GAINS]


def _local(formation: str) -> list[Scenario]:
    return [transport(formation, material, 0.0) for material in MATERIALS]


def _bars() -> list[Scenario]:
    return [transport("quadrilateral", "rubber", 0.0), *map(topology, TOPOLOGIES)]


def _curve(number: int, title: str, runs: Callable[[], list[Scenario]], draw: Callable[[Store], Figure]) -> Part:
    name = f"fig{number}"
    return Part(runs=runs, make=partial(_figure, name, f"Figure {number}. {title}", draw))


def _curves(formation: str, numbers: dict[str, int]) -> dict[str, Part]:
    """The figures that the paper shows alike for several formations."""
    kinds: dict[str, tuple[str, Callable[[], list[Scenario]], Callable[[Store], Figure]]] = {
        "gather": ("Aggregation", partial(_aggregations, formation), partial(curves.aggregation_paths, formation)),
        "positions": (
            "Aggregation for three consensus gains",
            partial(_aggregations, formation),
            partial(curves.aggregation_positions, formation),
        ),
        "agreement": (
            "Consensus error during aggregation",
            partial(_aggregations, formation),
            partial(curves.aggregation_errors, formation),
        ),
        "paths": ("Transport", partial(transports, formation), partial(curves.transport_paths, formation)),
        "velocities": ("Velocities", partial(_local, formation), partial(curves.velocities, formation)),
        "tracking": ("Tracking error", partial(transports, formation), partial(curves.tracking_errors, formation)),
        "consensus": ("Consensus error", partial(transports, formation), partial(curves.consensus_errors, formation)),
    }
    parts = {}
    for kind, number in numbers.items():
        title, runs, draw = kinds[kind]
        parts[f"fig{number}"] = _curve(number, f"{title}, {formation}", runs, draw)
    return parts


_TABLE_TITLES = {
    "table1": "Table 1. Stiffness of the transport objects",
    "table2": "Table 2. Tracking error, line",
    "table3": "Table 3. Consensus error and control input, line",
    "table4": "Table 4. Tracking error, quadrilateral",
    "table5": "Table 5. Consensus error and control input, quadrilateral",
    "table6": "Table 6. Consensus error and control input, octagon",
}


def _parts() -> dict[str, Part]:
    tables = {
        name: Part(runs=partial(table_runs, name), make=partial(_table, name, title))
        for name, title in _TABLE_TITLES.items()
    }
    drawn = {
        "fig1": Part(
            runs=_no_runs,
            make=partial(_figure, "fig1", "Figure 1. Mass-spring model", lambda _store: schematics.mass_spring_model()),
        ),
        "fig2": Part(runs=_no_runs, make=partial(_block_diagram, "fig2", "Figure 2. The whole control system", None)),
        "fig3": Part(runs=_no_runs, make=partial(_block_diagram, "fig3", "Figure 3. One robot", "robot_1")),
        **_curves(
            "line",
            {"gather": 4, "positions": 5, "agreement": 6, "paths": 7, "velocities": 8, "tracking": 9, "consensus": 11},
        ),
        "fig10": _curve(10, "Distance d12 at δ = 0, line", partial(_local, "line"), curves.relative_distance),
        **_curves(
            "quadrilateral",
            {
                "gather": 12,
                "positions": 13,
                "agreement": 14,
                "paths": 15,
                "velocities": 16,
                "tracking": 17,
                "consensus": 18,
            },
        ),
        "fig19": _curve(19, "An s-curve with four robots", lambda: [s_curve()], s_curve_figure),
        "fig20": _curve(20, "The three formations", _no_runs, lambda _store: schematics.formations()),
        **_curves("octagon", {"paths": 21}),
        "fig22": _curve(22, "Communication topologies", _no_runs, lambda _store: schematics.topologies()),
        "fig23": _curve(23, "Consensus error by topology", _bars, curves.topology_bars),
    }
    figures = dict(sorted(drawn.items(), key=lambda item: int(item[0].removeprefix("fig"))))
    return {
        "parameters": Part(runs=_no_runs, make=_provenance),
        **tables,
        "claims": Part(runs=claim_runs, make=_claims),
        "fit": Part(runs=_no_runs, make=_fit),
        "trajectories": Part(runs=trajectory_runs, make=_trajectories),
        "readings": Part(runs=readings.reading_runs, make=_readings),
        "bandwidth": Part(runs=bandwidth_runs, make=_bandwidth),
        "sensitivity": Part(runs=sensitivity_runs, make=_sensitivity),
        **figures,
    }


PARTS: dict[str, Part] = _parts()
"""Every part of the study by name, in the order of the report."""
