"""One cell of the tables, run again by both readings, for whoever doubts it."""

from drake_formation.config.errors import nearest
from drake_formation.markdown import markdown_table
from drake_formation.measuring import Metrics
from drake_formation.paper.measured import measured
from drake_formation.paper.quantities import TABLES
from drake_formation.paper.readings.agreement import cell_rows
from drake_formation.paper.runs import GAINS, MATERIALS
from drake_formation.paper.tables import cells
from drake_formation.scenario import Scenario
from drake_formation.simulation import simulate


class Fresh:
    """Figures of runs that are made when they are asked for, and not kept: a store that has nothing."""

    def measured(self, scenario: Scenario) -> Metrics:
        """The figures of a scenario's run."""
        return measured(scenario, simulate(scenario, engine="compiled"))


def rerun(name: str) -> str:
    """Run the cells of a table with a material and a gain, and set them beside the published ones.

    Args:
        name: ``TABLE:MATERIAL:GAIN``, such as ``table5:steel:1e4``.

    Returns:
        A Markdown table, and why numbers differ where they do.

    Raises:
        ValueError: there is no such cell.
    """
    table, material, delta = _parsed(name)
    found = [cell for quantity in TABLES[table] for cell in cells(quantity, Fresh(), (material, delta))]
    heading, rows, notes = cell_rows(found)
    return "\n".join([markdown_table(heading, rows), *notes])


def _parsed(name: str) -> tuple[str, str, float]:
    table, material, gain = (*name.split(":"), "", "")[:3]
    gains = {f"{delta:g}": delta for delta in GAINS}
    try:
        delta = float(gain)
    except ValueError:
        delta = -1.0
    if name.count(":") != 2 or table not in TABLES or material not in MATERIALS or delta not in GAINS:
        near = nearest(table, TABLES)
        hint = f", did you mean {near!r}?" if near and near != table else ""
        raise ValueError(
            f"no cell {name!r}{hint}; a cell is TABLE:MATERIAL:GAIN with {', '.join(TABLES)}; {', '.join(MATERIALS)}; "
            f"{', '.join(gains)}"
        )
    return table, material, delta
