"""Two readings of "detected by the nearest robot only", side by side: which explains more of the tables."""

from collections.abc import Callable

from drake_formation.markdown import markdown_table
from drake_formation.paper.runs import FORMATIONS, GAINS, MATERIALS, transport
from drake_formation.paper.store import Store
from drake_formation.paper.tables import TABLES, Cell
from drake_formation.scenario import Scenario, with_overrides


def nearest_only(formation: str, material: str, delta: float) -> Scenario:
    """A cell of the tables where an obstacle is felt by the robot nearest to it alone."""
    return with_overrides(transport(formation, material, delta), {"avoidance.sensing": "nearest"})


READINGS: dict[str, Callable[[str, str, float], Scenario]] = {
    "every robot within range (used)": transport,
    "the nearest robot within range": nearest_only,
}
"""Who feels an obstacle; no other number differs."""


def reading_runs() -> list[Scenario]:
    """The runs of both readings."""
    cases = [(formation, material, delta) for formation in FORMATIONS for material in MATERIALS for delta in GAINS]
    return [run(*case) for run in READINGS.values() for case in cases]


def comparison(store: Store) -> str:
    """How many cells of each table agree by each reading, as a Markdown table."""
    rows = []
    for name, run in READINGS.items():
        tables = [[cell for quantity in TABLES[table] for cell in quantity.cells(store, run)] for table in TABLES]
        counts = [agreement(cells) for cells in [*tables, [cell for cells in tables for cell in cells]]]
        rows.append([name, *counts])
    return markdown_table(["who feels an obstacle", *TABLES, "all"], rows)


def agreement(cells: list[Cell]) -> str:
    """``7 of 12``: how many cells agree."""
    return f"{sum(cell.agrees for cell in cells)} of {len(cells)}"
