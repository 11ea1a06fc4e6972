"""Tables 1-6 of the paper: each cell as published and by both readings, and why it differs where it does."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from drake_formation.paper.published import published
from drake_formation.paper.quantities import TABLES, Measure, Quantity
from drake_formation.paper.readings.score import AGREES, agrees
from drake_formation.paper.readings.two_readings import READINGS, Place, Run
from drake_formation.paper.reasons import reason
from drake_formation.paper.runs import CASES, MATERIALS
from drake_formation.paper.store import Measures, Store
from drake_formation.scenario import Scenario


@dataclass(frozen=True, kw_only=True)
class Entry:
    """A number of the paper beside a run's.

    Attributes:
        quantity: what it is.
        place: where it is printed.
        robot: whose, from 1; 0 where it is all robots'.
        published: as printed.
        ours: from the run.
    """

    quantity: Quantity
    place: Place
    robot: int
    published: float
    ours: float


@dataclass(frozen=True, kw_only=True)
class Cell:
    """One number of a table.

    Attributes:
        table: such as ``Table 3``.
        row: which quantity and gain.
        column: which material (and robot).
        unit: of all numbers.
        published: as printed.
        ours: from our runs, by the name of the reading.
        set_by: by the reading, the parameter that this number set; empty for a prediction.
        reasons: by the reading, why the two differ, where they do not agree.
        rerun: the command that makes it again.
    """

    table: str
    row: str
    column: str
    unit: str
    published: float
    ours: dict[str, float]
    set_by: dict[str, str] = field(default_factory=dict)
    reasons: dict[str, str] = field(default_factory=dict)
    rerun: str = ""

    def agrees(self, reading: str, share: float = AGREES) -> bool:
        """Whether a reading gives what is published, to within a share of it."""
        return agrees(self.published, self.ours[reading], share)


def table1() -> list[Cell]:
    """Material properties."""
    return [
        Cell(
            table="Table 1",
            row="stiffness k",
            column=name,
            unit="N/m",
            published=printed,
            ours=dict.fromkeys(READINGS, MATERIALS[name]),
        )
        for name, printed in published()["materials"].items()
    ]


def entries(
    quantity: Quantity,
    store: Measures,
    run: Run,
    measure: Measure | None = None,
    only: tuple[str, float] | None = None,
) -> Iterator[Entry]:
    """The paper's numbers of a quantity beside those of some runs.

    Args:
        quantity: what the paper prints.
        store: has the runs' figures.
        run: the transport of a formation, a material and a gain.
        measure: what to take of a run's figures instead of what the quantity says.
        only: material and gain; all if None.
    """
    for material, by_gain in published()[quantity.formation][quantity.key].items():
        for delta, numbers in by_gain.items():
            if only and only != (material, delta):
                continue
            place = Place(quantity.formation, quantity.key, material, delta)
            ours = (measure or quantity.measure)(store.measured(run(quantity.formation, material, delta)))
            printed = numbers if isinstance(numbers, list) else [numbers]
            for k, (theirs, mine) in enumerate(zip(printed, ours, strict=True), start=1):
                robot = k if len(ours) > 1 else 0
                yield Entry(quantity=quantity, place=place, robot=robot, published=theirs, ours=mine)


def cells(quantity: Quantity, store: Measures, only: tuple[str, float] | None = None) -> Iterator[Cell]:
    """The cells of a quantity by both readings; of one material and gain if asked for."""
    by_reading = [list(entries(quantity, store, reading.transport, only=only)) for reading in READINGS.values()]
    for both in zip(*by_reading, strict=True):
        first, place = both[0], both[0].place
        ours = {key: entry.ours for key, entry in zip(READINGS, both, strict=True)}
        missed = [key for key, value in ours.items() if not agrees(first.published, value)]
        yield Cell(
            table=quantity.table,
            row=f"{quantity.row}, δ = {place.delta:g}",
            column=f"{place.material}, robot {first.robot}" if first.robot else place.material,
            unit=quantity.unit,
            published=first.published,
            ours=ours,
            set_by={key: reading.set_by(place) for key, reading in READINGS.items()},
            reasons={key: reason(key, place, store) for key in missed},
            rerun=rerun_command(quantity.table, place.material, place.delta),
        )


def rerun_command(table: str, material: str, delta: float) -> str:
    """The command that runs a cell again by both readings."""
    return f"drake-formation reproduce --cell {table.lower().replace(' ', '')}:{material}:{delta:g}"


def transports(run: Run) -> list[Scenario]:
    """All cells' transports of a reading."""
    return [run(*case) for case in CASES]


def table_runs(name: str) -> list[Scenario]:
    """The runs a table needs."""
    formations = {quantity.formation for quantity in TABLES.get(name, ())}
    cases = [(formation, material, delta) for formation, material, delta in CASES if formation in formations]
    return [reading.transport(*case) for reading in READINGS.values() for case in cases]


def table(name: str, store: Store) -> list[Cell]:
    """A table's cells."""
    if name == "table1":
        return table1()
    return [cell for quantity in TABLES[name] for cell in cells(quantity, store)]


def all_entries(store: Store, run: Run, measures: Mapping[str, Measure] = MappingProxyType({})) -> list[Entry]:
    """All numbers of Tables 2-6 beside those of some runs.

    Args:
        store: has the runs.
        run: see :func:`entries`.
        measures: by table, what to take of a run's figures instead of what its quantities say.
    """
    return [
        entry
        for name in TABLES
        for quantity in TABLES[name]
        for entry in entries(quantity, store, run, measures.get(quantity.table))
    ]
