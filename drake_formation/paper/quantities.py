"""The quantities that the paper's tables print, and what of a run's figures each is."""

from collections.abc import Callable
from dataclasses import dataclass

from drake_formation.measuring import Metrics

Measure = Callable[[Metrics], list[float]]
"""The numbers of a cell, one or one a robot, in the table's unit."""


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """A block of cells: one quantity of a formation for both materials and three gains.

    Attributes:
        table: such as ``Table 3``.
        formation: shipped scenario.
        key: its key in ``published.yaml``.
        row: what is printed before the gain.
        unit: as in the paper; its "%" reads as cm.
        measure: what of a run's figures it is.
    """

    table: str
    formation: str
    key: str
    row: str
    unit: str
    measure: Measure


def _errors(table: str, formation: str) -> Quantity:
    return Quantity(
        table=table,
        formation=formation,
        key="consensus_error",
        row="largest ‖e_i‖",
        unit="cm",
        measure=lambda figures: [100 * figures.consensus_error_m],
    )


def _forces(table: str, formation: str) -> Quantity:
    return Quantity(
        table=table,
        formation=formation,
        key="peak_force",
        row="largest ‖u_i‖",
        unit="N",
        measure=lambda figures: [figures.peak_force_n],
    )


TABLES: dict[str, tuple[Quantity, ...]] = {
    "table2": (
        Quantity(
            table="Table 2",
            formation="line",
            key="tracking_error",
            row="‖ε_i‖",
            unit="cm",
            measure=lambda figures: [100 * error for error in figures.tracking_error_m],
        ),
    ),
    "table3": (_errors("Table 3", "line"), _forces("Table 3", "line")),
    "table4": (
        Quantity(
            table="Table 4",
            formation="quadrilateral",
            key="tracking_error",
            row="‖ε‖ of all robots",
            unit="cm",
            measure=lambda figures: [100 * figures.stacked_tracking_error_m],
        ),
    ),
    "table5": (_errors("Table 5", "quadrilateral"), _forces("Table 5", "quadrilateral")),
    "table6": (_errors("Table 6", "octagon"), _forces("Table 6", "octagon")),
}
"""What each table is made of; Table 1 needs no run."""


def largest_robot(figures: Metrics) -> list[float]:
    """Table 4 read as Table 2: the largest tracking error of any robot (cm)."""
    return [100 * max(figures.tracking_error_m)]
