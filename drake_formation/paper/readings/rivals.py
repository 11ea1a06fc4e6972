"""Readings that are as good as the probable one, and what would tell them apart."""

from collections.abc import Callable

import numpy as np

from drake_formation.markdown import markdown_table
from drake_formation.measuring import Metrics
from drake_formation.paper.figures.curves import phase
from drake_formation.paper.readings.fit import CASE
from drake_formation.paper.readings.score import Score, score
from drake_formation.paper.readings.simulated import BySettings
from drake_formation.paper.readings.variants import alternatives, by
from drake_formation.paper.runs import CASES
from drake_formation.paper.section import Part, Section
from drake_formation.paper.store import Store
from drake_formation.paper.tables import all_entries, transports
from drake_formation.vectors import length

Key = tuple[str, float, float]
"""Law, ρ0 (m), and δ while gathering (N/m)."""

AS_GOOD = 3
"""So many kinds of readings are looked at closely, each with the width of the field that serves it best."""

FREE = (
    "ρ0",
    "η",
    "D of two robots",
    "D of more",
    "T_agg of two robots",
    "T_agg of four",
    "T_agg of eight",
    "that one robot feels an obstacle",
    "which does in the octagon",
    "the octagon's size",
)
"""What the paper does not give of any reading with a soft, wide push."""

UNPRINTED: dict[str, Callable[[Metrics], float]] = {
    "‖ε‖ of all robots (cm)": lambda figures: 100 * figures.stacked_tracking_error_m,
    "least clearance (m)": lambda figures: figures.min_clearance_m,
    "turning of the formation (cm)": lambda figures: 100 * figures.turned_m,
    "RMS force (N)": lambda figures: figures.rms_force_n,
    "energy (J)": lambda figures: figures.energy_j,
}
"""Figures that the paper does not print for every transport."""
PRINTED_ERRORS = ("line", "quadrilateral")
"""Formations whose tracking errors it prints."""

RISEN = 0.1
"""A tracking error is there from when it is first this share of its largest."""


def rivals_part() -> Part:
    """Other readings that explain as much."""
    return Part(
        make=lambda store: Section(title="Readings that are as good", text=_text(store)),
        runs=lambda: [by(settings)(*CASE) for settings in alternatives().values()],
        measured=lambda: [run for settings in alternatives().values() for run in transports(by(settings))],
    )


def _text(store: Store) -> str:
    scores = {key: _score(store, settings) for key, settings in alternatives().items()}
    ranked = sorted(scores, key=lambda key: (-scores[key].agree, -scores[key].close))
    kinds = list({(law, gathering): (law, width, gathering) for law, width, gathering in reversed(ranked)}.values())
    best = sorted(kinds, key=ranked.index)[:AS_GOOD]
    widths = sorted((key for key in ranked if (key[0], key[2]) == (best[0][0], best[0][2])), key=lambda key: key[1])
    extremes = [widths[0], widths[-1]]
    heading = [
        "virtual springs", "ρ0 (m)", "η (N m²), fitted", "δ while gathering", "free choices", "agree", "close",
        "median difference",
    ]  # fmt: skip
    return "\n\n".join([
        f"Laws, widths of the field and ways to gather, {len(scores)} in all, each with η fitted to the line's error "
        f"alone. Free choices are {', '.join(FREE)}; δ while gathering, if any; and a law that depends on N:",
        markdown_table(heading, [_row(key, scores[key]) for key in ranked]),
        f"The best of {AS_GOOD} kinds have {', '.join(str(scores[key].agree) for key in best)} cells. What the paper "
        "does not print and would tell them apart, in the transport in which they differ most:",
        _apart(store, best),
        f"The width of the field is worth {abs(scores[extremes[0]].agree - scores[extremes[1]].agree)} cells from "
        f"{extremes[0][1]:g} to {extremes[1][1]:g} m, and the tables do not fix it. What would:",
        _apart(store, extremes),
    ])  # fmt: skip


def free_choices(key: Key) -> int:
    """How much of a reading the paper does not give: ``FREE``, δ while gathering, and an exception to one law."""
    mixed = len({its.law for its in alternatives()[key].values()}) > 1
    return len(FREE) + (key[2] > 0) + mixed


def rise(store: Store, settings: BySettings) -> float:
    """Time from when the line's tracking error with rubber is there to when it is largest (s)."""
    carried = phase(store[by(settings)(*CASE)], 1)
    error = length(carried["deviation"]).max("robot").values
    time = carried["time"].values
    return float(time[error.argmax()] - time[np.argmax(error > RISEN * error.max())])


def _row(key: Key, its: Score) -> list[str]:
    law, width, gathering = key
    numbers = [f"{width:g}", f"{alternatives()[key]['line'].gain:.3g}", f"{gathering:g} N/m", str(free_choices(key))]
    return [law, *numbers, f"**{its}**", str(its.close), f"{100 * its.off:.1f} %"]


def _apart(store: Store, keys: list[Key]) -> str:
    settings = [alternatives()[key] for key in keys]
    found = [("rise of ‖ε_i‖ (s)", CASE, [rise(store, its) for its in settings])]
    for name, figure in UNPRINTED.items():
        values = {
            case: [figure(store.measured(by(its)(*case))) for its in settings]
            for case in CASES
            if "ε" not in name or case[0] not in PRINTED_ERRORS
        }
        case = max(values, key=lambda case: _spread(values[case]))
        found.append((name, case, values[case]))
    rows = [
        [
            name,
            f"{case[0]}, {case[1]}, δ = {case[2]:g}",
            *(f"{value:.3g}" for value in values),
            f"{_spread(values):.2f}",
        ]
        for name, case, values in sorted(found, key=lambda row: -_spread(row[2]))
    ]
    return markdown_table(["figure", "transport", *map(_name, keys), "largest by least"], rows)


def _spread(values: list[float]) -> float:
    return max(values) / min(values)


def _name(key: Key) -> str:
    law, width, gathering = key
    return f"{law}, ρ0 = {width:g} m, gathering at {gathering:g} N/m"


def _score(store: Store, settings: BySettings) -> Score:
    return score((entry.published, entry.ours) for entry in all_entries(store, by(settings)))
