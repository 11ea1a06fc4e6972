"""Every parameter of the study: its value in the scenarios that run, by reading, and where it comes from."""

from collections.abc import Callable, Iterable

import numpy as np

from drake_formation.markdown import markdown_table
from drake_formation.paper.readings.simulated import SIMULATED, passes
from drake_formation.paper.readings.two_readings import PRINTED, PROBABLE
from drake_formation.paper.runs import AGGREGATION_GAINS, FORMATIONS, GAINS, MATERIALS
from drake_formation.paper.section import Part, Section
from drake_formation.scenario import Scenario, resolve, with_overrides

Value = Callable[[Scenario], object]


def _side(scenario: Scenario) -> float | None:
    side: float | None = getattr(scenario.formation, "side", None)
    return side


def _feels(scenario: Scenario) -> str:
    avoidance = scenario.avoidance
    if avoidance.sensing == "assigned":
        return f"robots {' and '.join(map(str, avoidance.assigned))} (N = {resolve(scenario).robots})"
    return {"nearest": "the nearest robot, within ρ0", "in_range": "every robot within ρ0"}[avoidance.sensing]


SCENARIOS: tuple[tuple[str, Value, str, str], ...] = (
    ("mass", lambda s: s.robots.mass, "kg", "published"),
    ("velocity consensus gain δ_v", lambda s: s.consensus.delta_v, "N s/m", "inferred: Δ is dimensionally inconsistent "
     "as printed; read as [δ I, 0]"),
    ("virtual springs", lambda s: {"linear": "on displacements", "hookean": "along lines"}[s.consensus.law], "",
     "on displacements: published, Eq. 15; along lines: inferred, for more than two robots only, against Eq. 15"),
    ("Q, R", lambda s: f"{s.tracking.Q:g} I4, {s.tracking.R:g} I2", "", "published"),
    ("side of line and square", _side, "m", "published"),
    ("octagon, across flats", lambda s: getattr(s.formation, "width", None), "m",
     "inferred: at side 1 m the top edge would pass {passes} from an obstacle"),
    ("distance D", lambda s: float(np.linalg.norm(resolve(s).goal - resolve(s).centre)), "m",
     "inferred from the peak force at δ = 0"),
    ("obstacles", lambda s: "; ".join(f"({o.position[0]:g}, {o.position[1]:g})" for o in s.avoidance.obstacles), "m",
     "published"),
    ("sensing range ρ0", lambda s: s.avoidance.range, "m",
     "as printed: inferred; as probably simulated: chosen of several that do as well"),
    ("avoidance gain η", lambda s: s.avoidance.gain, "N m²", "inferred: fitted to one error of the line"),
    ("who feels an obstacle", _feels, "",
     "the nearest: published; one fixed robot: inferred, in the octagon of equally near ones chosen by the errors"),
    ("spring and consensus graph", lambda s: ", ".join(dict.fromkeys([s.springs.graph, s.consensus.graph])), "",
     "published"),
    ("transport duration", lambda s: s.transport.duration, "s", "chosen"),
)  # fmt: skip
"""Parameters that are the same for all cells of a formation: what, where in a scenario, its unit and its source."""


def provenance_part() -> Part:
    """The table of parameters."""
    return Part(make=lambda _store: Section(title="Parameters and where they come from", text=provenance()))


def provenance() -> str:
    """The parameters as a Markdown table."""
    cases = [[reading.transport(name, "rubber", 0.0) for name in FORMATIONS] for reading in (PRINTED, PROBABLE)]
    passes = f"{side_of_a_metre():.2f} m"
    rows = [
        [name, *(_with_unit(map(value, scenarios), unit) for scenarios in cases), source.format(passes=passes)]
        for name, value, unit, source in SCENARIOS
    ]
    heading = ["parameter", PRINTED.title, PROBABLE.title, "provenance"]
    return markdown_table(heading, [*_of_cells(), *rows, *_of_aggregation(cases[0])])


def side_of_a_metre() -> float:
    """How far from an obstacle an octagon of side 1 m would pass on its way (m)."""
    octagon = {"shape": "polygon", "robots": 8, "side": 1.0}
    scenario = with_overrides(PRINTED.transport("octagon", "rubber", 0.0), {"formation": octagon})
    return float(passes(resolve(scenario)).min())


def _of_cells() -> list[list[str]]:
    stiffness = _with_unit([f"{k:g} ({name})" for name, k in MATERIALS.items()], "N/m")
    gains = _with_unit(GAINS, "N/m")
    return [["stiffness k", stiffness, stiffness, "published"], ["consensus gain δ", gains, gains, "published"]]


def _of_aggregation(printed: list[Scenario]) -> list[list[str]]:
    settings = [SIMULATED[name] for name in FORMATIONS]
    gathering = _with_unit((its.gathering_gain for its in settings), "N/m")
    starts = "published.yaml (N = 2, 4); seeded random (N = 8)"
    drawn = _with_unit(AGGREGATION_GAINS, "N/m")
    return [
        ["starts", starts, starts, "published (N = 2, 4); chosen (N = 8): the paper says random"],
        [
            "aggregation time T_agg",
            _with_unit((s.aggregation.duration for s in printed), "s"),
            _with_unit((its.duration for its in settings), "s"),
            "inferred: from the floors of the consensus error as printed, from the forces as probably simulated",
        ],
        ["δ while gathering", "that of the transport", gathering, "inferred as probably simulated"],
        ["δ of the aggregation figures", drawn, drawn, "chosen: the figures are lost"],
    ]


def _with_unit(values: Iterable[object], unit: str) -> str:
    """``22.5, 25 m``: the values in the order of the formations, each once where they are all the same."""
    shown = [f"{value:g}" if isinstance(value, float) else str(value) for value in values if value is not None]
    different = shown if len(set(shown)) > 1 else shown[:1]
    return f"{', '.join(different)} {unit}".rstrip()
