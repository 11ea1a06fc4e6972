"""The folder that a comparison leaves behind."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from drake_formation.cli.run_folder import SCENARIO
from drake_formation.compare.comparison import Comparison
from drake_formation.compare.run import Outcome
from drake_formation.compare.table import COLUMNS, Row, as_csv, latex, markdown
from drake_formation.places import PICTURES, Kind, Place, Written, written
from drake_formation.scenario import dump_scenario
from drake_formation.terminal.tables import table as empty_table
from drake_formation.viz.style import attempt_each

if TYPE_CHECKING:
    from rich.table import Table

TABLE, SCENARIOS, RUNS = "table.csv", "scenarios", "runs.json"
COMPARISON = Kind(RUNS, (TABLE, "table.md", "table.tex", SCENARIOS, PICTURES, RUNS))


def write_comparison(
    place: Place,
    comparison: Comparison,
    outcomes: Sequence[Outcome],
    table: Sequence[Row],
    file_format: str = "png",
) -> Written:
    """Write tables, each run's figures and its scenario, and pictures.

    Raises:
        OutputError: it cannot be written anywhere.
    """

    def write(folder: Path) -> dict[str, str]:
        (folder / TABLE).write_text(as_csv(table), encoding="utf-8")
        (folder / "table.md").write_text(markdown(comparison, table), encoding="utf-8")
        (folder / "table.tex").write_text(latex(comparison, table), encoding="utf-8")
        (folder / SCENARIOS).mkdir()
        runs = [_written_run(folder, number, outcome) for number, outcome in enumerate(outcomes, start=1)]
        (folder / RUNS).write_text(json.dumps(runs, indent=2) + "\n", encoding="utf-8")
        (folder / PICTURES).mkdir()
        failed: dict[str, str] = {}

        def draw() -> None:
            from drake_formation.compare.figures import write_comparison_figures

            failed.update(write_comparison_figures(comparison, outcomes, table, folder / PICTURES, file_format))

        return attempt_each({PICTURES: draw}) | failed

    return written(place, write)


def summary(comparison: Comparison, table: Sequence[Row]) -> "Iterator[Table]":
    """A table a case; the best figures are marked with a star."""
    for case in comparison.cases:
        title = comparison.name if len(comparison.cases) == 1 else f"{comparison.name}, {case}"
        shown = empty_table("law", *(f"{label} ({unit})" for label, unit in COLUMNS.values()), "channels", title=title)
        for row in (row for row in table if row.case == case):
            cells = [f"{cell.text()} *" if cell.best else cell.text() for cell in row.cells.values()]
            shown.add_row(row.law, *cells, str(row.channels))
        yield shown


def told(outcome: Outcome) -> dict[str, object]:
    """A run's own figures."""
    run = outcome.run
    return {
        "law": run.law, "case": run.case, "seed": run.seed, "metrics": outcome.metrics,
        "failure": outcome.failure or None,
    }  # fmt: skip


def _written_run(folder: Path, number: int, outcome: Outcome) -> dict[str, object]:
    """The same, and where its scenario, which repeats it, is written beside them."""
    scenario = f"{SCENARIOS}/{number}-{SCENARIO}"
    dump_scenario(outcome.run.scenario, folder / scenario)
    return told(outcome) | {"scenario": scenario}
