"""The table of a comparison: a row a law, a column a figure, the best in bold."""

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import fmean, stdev

from drake_formation.compare.comparison import Comparison
from drake_formation.compare.run import Outcome
from drake_formation.markdown import markdown_table

COLUMNS = {
    "tracking_error_m": ("tracking error", "m"),
    "consensus_error_m": ("consensus error", "m"),
    "max_spring_strain": ("strain", "1"),
    "min_clearance_m": ("clearance", "m"),
    "peak_force_n": ("peak force", "N"),
    "rms_force_n": ("RMS force", "N"),
    "energy_j": ("energy", "J"),
}
"""Metrics that are compared: what tables call each, and its unit."""

STRAIN, BODY_STRAIN = "max_spring_strain", "max_object_strain"
"""An object that is a body of its own has the other strain."""

MORE_IS_BETTER = ("min_clearance_m",)
DIGITS = 3
ROUNDING = 1e-9
"""A deviation of so small a part of the mean is rounding."""


@dataclass(frozen=True)
class Cell:
    """A figure of a law over its runs in a case.

    Attributes:
        mean: over the runs that were finished; not a number where none was.
        spread: their standard deviation; 0 for one run.
        best: whether no other law of the case is better, to the digits shown.
    """

    mean: float
    spread: float
    best: bool = False

    def text(self) -> str:
        """Mean and, where there are several runs, deviation."""
        if math.isnan(self.mean):
            return "–"
        return f"{self.mean:.{DIGITS}g}" + (f" ± {self.spread:.2g}" if self.spread > ROUNDING * abs(self.mean) else "")


@dataclass(frozen=True)
class Row:
    """A law in a case.

    Attributes:
        case: name of the case.
        law: name of the law.
        cells: by metric, those of ``COLUMNS``.
        channels: that its laws read.
        messages: a second over them; infinity where they are heard all the time.
        runs: how many there were,
        finished: and how many of them were finished.
    """

    case: str
    law: str
    cells: dict[str, Cell]
    channels: int
    messages: float
    runs: int
    finished: int


def rows(comparison: Comparison, outcomes: Sequence[Outcome]) -> list[Row]:
    """The rows of a comparison's table, case by case."""
    table: list[Row] = []
    for case in comparison.cases:
        by_law = {law: [o for o in outcomes if (o.run.case, o.run.law) == (case, law)] for law in comparison.laws}
        table += _judged([_row(case, law, own) for law, own in by_law.items()])
    return table


def markdown(comparison: Comparison, table: Sequence[Row]) -> str:
    """As Markdown, a table a case."""
    heading = ["law", *(f"{label} ({unit})" for label, unit in COLUMNS.values()), "channels", "messages/s", "runs"]
    parts = []
    for case in comparison.cases:
        if len(comparison.cases) > 1:
            parts.append(f"**{case}**")
        parts.append(markdown_table(heading, [_in_markdown(row) for row in table if row.case == case]))
    return "\n\n".join(parts) + "\n"


def latex(comparison: Comparison, table: Sequence[Row]) -> str:
    """As a LaTeX tabular, which needs no package."""
    metrics = (f"{label} ({_escaped(unit)})" for label, unit in COLUMNS.values())
    heading = ["law", *metrics, "channels", "messages/s", "runs"]
    lines = [rf"\begin{{tabular}}{{l{'r' * (len(heading) - 1)}}}", r"\hline", _line(heading), r"\hline"]
    for case in comparison.cases:
        if len(comparison.cases) > 1:
            lines.append(_line([rf"\multicolumn{{{len(heading)}}}{{l}}{{\emph{{{_escaped(case)}}}}}"]))
        for row in (row for row in table if row.case == case):
            cells = [_in_latex(cell) for cell in row.cells.values()]
            rate = r"$\infty$" if math.isinf(row.messages) else _rate(row.messages)
            lines.append(_line([_escaped(row.law), *cells, str(row.channels), rate, _count(row)]))
    return "\n".join([*lines, r"\hline", r"\end{tabular}"]) + "\n"


def as_csv(table: Sequence[Row]) -> str:
    """As CSV, in full precision: a mean and a deviation a metric."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    columns = [f"{name}{ending}" for name in COLUMNS for ending in ("", "_deviation")]
    writer.writerow(["case", "law", *columns, "channels", "messages_per_s", "runs", "finished"])
    for row in table:
        figures = [value for cell in row.cells.values() for value in (cell.mean, cell.spread)]
        writer.writerow([row.case, row.law, *figures, row.channels, row.messages, row.runs, row.finished])
    return stream.getvalue()


def _row(case: str, law: str, outcomes: Sequence[Outcome]) -> Row:
    finished = [outcome for outcome in outcomes if not outcome.failure]
    cells = {name: _cell([_number(outcome, name) for outcome in finished]) for name in COLUMNS}
    first = outcomes[0]
    return Row(case, law, cells, first.channels, first.messages, len(outcomes), len(finished))


def _number(outcome: Outcome, name: str) -> float:
    """A metric as one number: of robots the worst."""
    value = outcome.metrics.get(name)
    if value is None and name == STRAIN:
        value = outcome.metrics.get(BODY_STRAIN)
    if value is None:
        return math.nan
    return max(value) if isinstance(value, list) else value


def _cell(values: Sequence[float]) -> Cell:
    known = [value for value in values if not math.isnan(value)]
    if not known:
        return Cell(math.nan, 0.0)
    return Cell(fmean(known), stdev(known) if len(known) > 1 else 0.0)


def _judged(table: Sequence[Row]) -> list[Row]:
    """The rows of a case with the best of each column marked; where all are alike, none is. Failed runs win nothing."""
    best: dict[str, float] = {}
    for name in COLUMNS:
        sign = -1.0 if name in MORE_IS_BETTER else 1.0
        shown = [sign * float(f"{row.cells[name].mean:.{DIGITS}g}") for row in table if row.finished == row.runs]
        shown = [value for value in shown if not math.isnan(value)]
        if len(set(shown)) > 1:
            best[name] = sign * min(shown)
    return [
        replace(row, cells={
            name: replace(cell, best=row.finished == row.runs and _is_best(cell, best.get(name)))
            for name, cell in row.cells.items()
        })
        for row in table
    ]  # fmt: skip


def _is_best(cell: Cell, best: float | None) -> bool:
    return best is not None and not math.isnan(cell.mean) and float(f"{cell.mean:.{DIGITS}g}") == best


def _rate(messages: float) -> str:
    return "all the time" if math.isinf(messages) else f"{messages:.{DIGITS}g}"


def _count(row: Row) -> str:
    return str(row.runs) if row.finished == row.runs else f"{row.finished} of {row.runs}"


def _in_markdown(row: Row) -> list[str]:
    cells = [f"**{cell.text()}**" if cell.best else cell.text() for cell in row.cells.values()]
    return [row.law, *cells, str(row.channels), _rate(row.messages), _count(row)]


def _line(cells: Sequence[str]) -> str:
    return " & ".join(cells) + " \\\\"


def _in_latex(cell: Cell) -> str:
    text = cell.text().replace(" ± ", r" $\pm$ ").replace("–", "--")
    return rf"\textbf{{{text}}}" if cell.best else text


def _escaped(text: str) -> str:
    """Text as LaTeX takes it."""
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    special |= {character: f"\\{character}" for character in "&%$#_{}"}
    return "".join(special.get(character, character) for character in text)
