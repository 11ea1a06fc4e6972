"""What each ingredient of the probable reading is worth, what η from the line alone predicts, and what is as good."""

from drake_formation.markdown import markdown_table
from drake_formation.paper.readings.fit import fit
from drake_formation.paper.readings.score import Score, score
from drake_formation.paper.readings.simulated import SIMULATED, changed
from drake_formation.paper.readings.two_readings import PRINTED, PROBABLE, Run
from drake_formation.paper.readings.variants import LAWS, by, ingredients
from drake_formation.paper.runs import FORMATIONS
from drake_formation.paper.section import Part, Section
from drake_formation.paper.store import Store
from drake_formation.paper.tables import Entry, all_entries, transports


def ingredients_part() -> Part:
    """The ablation."""
    return Part(
        make=lambda store: Section(title="What each ingredient is worth", text=_ingredients(store)),
        measured=lambda: [run for variant in ingredients().values() for run in transports(variant.run)],
    )


def _ingredients(store: Store) -> str:
    rows = [[name, *_by_formation(variant.entries(store))] for name, variant in ingredients().items()]
    heading = ["reading", *FORMATIONS, "all", "close", "median difference"]
    return (
        "Cells that agree when one ingredient of the probable reading is left out or replaced, the others kept and "
        "nothing fitted again:\n\n" + markdown_table(heading, rows)
    )


def _by_formation(entries: list[Entry]) -> list[str]:
    parts = [_score([entry for entry in entries if entry.place.formation == name]) for name in FORMATIONS]
    whole = _score(entries)
    return [*map(str, parts), f"**{whole}**", str(whole.close), f"{100 * whole.off:.1f} %"]


def held_out() -> dict[str, Run]:
    """Readings with η from the line alone."""
    line = SIMULATED["line"]
    gain = fit(line).gain
    laws = {f"{PROBABLE.title}, {name}": by(changed(law=law, gain=gain)) for name, law in LAWS.items()}
    return {PRINTED.title: PRINTED.transport, **laws}


def hold_out_part() -> Part:
    """What the line alone predicts for more robots."""
    return Part(
        make=lambda store: Section(title="Fitted to two robots, held against four and eight", text=_held_out(store)),
        measured=lambda: [run for reading in held_out().values() for run in transports(reading)],
    )


def _held_out(store: Store) -> str:
    fits = {PRINTED.title: fit(), PROBABLE.title: fit(SIMULATED["line"])}
    sentences = [
        f"{name.capitalize()}, η = {its.gain:.3f} N m² gives e = {100 * its.error:.3f} cm for the line with rubber at "
        f"δ = 0 and ρ0 = {its.range:g} m (published: {100 * its.target:g} cm), found in {its.runs} runs; the scenarios "
        f"use {its.used:g}."
        for name, its in fits.items()
    ]
    rows = []
    for name, run in held_out().items():
        errors = [entry for entry in all_entries(store, run) if entry.place.quantity != "peak_force"]
        others = [entry for entry in errors if entry.place.formation != "line"]
        kinds = [
            _score([e for e in others if (e.place.formation, e.place.quantity) == kind])
            for kind in dict.fromkeys((e.place.formation, e.place.quantity) for e in others)
        ]
        rows.append([name, *map(str, kinds), f"**{_score(others)}**"])
    heading = ["reading", "‖ε‖, N = 4", "e, N = 4", "e, N = 8", "error cells of N = 4 and 8"]
    return "\n\n".join([
        " ".join(sentences),
        "With η from the line and no error of four or eight robots used for it, the error cells of these that agree "
        "(the laws, who feels an obstacle and T_agg are those of the reading, and were chosen with these cells seen):",
        markdown_table(heading, rows),
    ])  # fmt: skip


def _score(entries: list[Entry]) -> Score:
    return score((entry.published, entry.ours) for entry in entries)
