"""How far the two readings agree with the tables: cell by cell, counted, and without the cells that set parameters."""

from collections.abc import Iterable

from drake_formation.markdown import markdown_table
from drake_formation.paper.quantities import TABLES
from drake_formation.paper.readings.score import AGREES, CLOSE, Score, score
from drake_formation.paper.readings.two_readings import READINGS
from drake_formation.paper.section import Part, Section
from drake_formation.paper.store import Store
from drake_formation.paper.tables import Cell, Entry, all_entries, table, table_runs, transports

MARK = "°"
"""Marks a number of a reading that set one of its parameters."""


def table_part(name: str, title: str) -> Part:
    """One of the paper's tables, cell by cell."""
    return Part(
        make=lambda store: table_section(title, table(name, store)),
        measured=lambda: table_runs(name),
    )


def table_section(title: str, cells: list[Cell]) -> Section:
    """Cells as a Markdown table, with numbered reasons under it."""
    heading, rows, notes = cell_rows(cells)
    example = next((cell.rerun for cell in cells if cell.rerun), "")
    again = f"A cell is run again by `{example}`, and so on." if example else ""
    text = "\n\n".join(filter(None, [markdown_table(heading, rows), "\n".join(notes), again]))
    return Section(title=title, text=text, cells=cells)


def cell_rows(cells: list[Cell]) -> tuple[list[str], list[list[str]], list[str]]:
    """Heading and rows of a table of cells, and the numbered reasons why some differ."""
    reasons = list(dict.fromkeys(reason for cell in cells for reason in cell.reasons.values()))
    rows = [
        [cell.row, cell.column, f"{cell.published:g}", *(shown(cell, key, reasons) for key in READINGS), cell.unit]
        for cell in cells
    ]
    notes = [f"{number}. {reason}." for number, reason in enumerate(reasons, start=1)]
    heading = ["row", "column", "published", *(reading.title for reading in READINGS.values()), "unit"]
    return heading, rows, notes


def shown(cell: Cell, reading: str, reasons: list[str]) -> str:
    """``13.9 (+11 %)``, with the mark of a calibration, and the number of the reason where it does not agree."""
    value = cell.ours[reading]
    mark = MARK if cell.set_by.get(reading) else ""
    off = f"{100 * (value / cell.published - 1):+.0f} %"
    miss = f", differs: {reasons.index(cell.reasons[reading]) + 1}" if reading in cell.reasons else ""
    return f"{number(value)}{mark} ({off}{miss})"


def number(value: float) -> str:
    """A number of a table, to three digits or the unit."""
    return f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def agreement_part() -> Part:
    """Both readings, counted."""
    return Part(
        make=lambda store: Section(title="Two readings of the paper", text=_text(store)),
        measured=lambda: [run for reading in READINGS.values() for run in transports(reading.transport)],
    )


def _text(store: Store) -> str:
    rows = []
    for reading in READINGS.values():
        entries = all_entries(store, reading.transport)
        whole = _score(entries)
        parts = [_score(entry for entry in entries if entry.quantity in TABLES[name]) for name in TABLES]
        calibrations = _score(entry for entry in entries if reading.set_by(entry.place))
        predictions = _score(entry for entry in entries if not reading.set_by(entry.place))
        rows.append([
            reading.title, *map(str, parts), f"**{whole}**", str(whole.close), f"{100 * whole.off:.1f} %",
            str(calibrations), f"**{predictions}**",
        ])  # fmt: skip
    heading = [
        "reading", *(name.replace("table", "Table ") for name in TABLES), f"all, within {100 * AGREES:g} %",
        f"within {100 * CLOSE:g} %", "median difference", "of calibrations", "of predictions",
    ]  # fmt: skip
    return f"{SETTINGS}\n\n{markdown_table(heading, rows)}\n\n{prediction_sentence(store)}"


SETTINGS = f"""*As printed* takes the paper at its word: consensus on displacements (Eq. 15) throughout, an obstacle
felt by the nearest robot, δ the same while robots gather and after. *As probably simulated* explains the printed
numbers best of what was tried: obstacles push softly from afar and each is felt by one fixed robot, all cells of a
formation start from one hand-off state, and the virtual springs of four and eight robots act along the lines between
them. A number marked {MARK} set a parameter of that reading, and its agreement is no evidence for it. Cells agree
within {100 * AGREES:g} % of the published value.

What is ad hoc in the second reading: springs along lines for more than two robots only, against Eq. 15 as printed; one
fixed robot an obstacle, and in the octagon which of equally near ones; and T_agg, fitted to forces that depend on the
moment of a ringing. These and the width of the field were chosen after the tables of four and eight robots had been
seen; no single cell set them, and what rests on each is counted under "What each ingredient is worth"."""


def prediction_sentence(store: Store) -> str:
    """How many cells are predictions, for report and README."""
    parts = []
    for reading in READINGS.values():
        entries = all_entries(store, reading.transport)
        whole, predictions = _score(entries), _score(e for e in entries if not reading.set_by(e.place))
        parts.append(
            f"{reading.title} {whole} cells agree, and {predictions} of those that set no parameter and so are "
            "predictions"
        )
    text = "; ".join(parts)
    return f"{text[0].upper()}{text[1:]}."


def _score(entries: Iterable[Entry]) -> Score:
    return score((entry.published, entry.ours) for entry in entries)
