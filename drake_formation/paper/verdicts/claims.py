"""The paper's claims, each with a verdict, the number that decides it and the run it came from."""

from collections.abc import Callable
from dataclasses import replace

from drake_formation.markdown import markdown_table
from drake_formation.paper.readings.two_readings import READINGS, Reading
from drake_formation.paper.runs import AGGREGATION_GAINS, TOPOLOGIES, aggregation
from drake_formation.paper.section import Part, Section
from drake_formation.paper.store import Store
from drake_formation.paper.tables import transports
from drake_formation.paper.verdicts import gathering, keeping, safety, talking, theorems
from drake_formation.paper.verdicts.verdict import Claim
from drake_formation.scenario import Scenario

CLAIMS: tuple[Callable[[Store], Claim], ...] = (
    theorems.gain,
    gathering.finals,
    gathering.faster_aggregation,
    talking.exponential_cost,
    theorems.theorem_1,
    theorems.theorem_2,
    theorems.invariant_mean,
    theorems.lemmas,
    theorems.lemma_2,
)
"""Claims that are the same by both readings."""

CLAIMS_BY_READING: tuple[Callable[[Reading, Store], Claim], ...] = (
    keeping.any_stiffness,
    keeping.forces_fit_errors,
    keeping.diminishing_returns,
    keeping.rubber_needs_it_more,
    keeping.trade_off,
    keeping.scalable,
    keeping.small_for_many,
    talking.topologies_beat_local,
    talking.ten_as_twelve,
    safety.avoids_collisions,
)


def claims_part() -> Part:
    """Every claim, in a table."""
    return Part(make=_section, runs=claim_runs, measured=claim_figures)


def claim_runs() -> list[Scenario]:
    """The runs whose results the claims need."""
    return [*(aggregation("line", delta) for delta in AGGREGATION_GAINS), theorems.drifting()]


def claim_figures() -> list[Scenario]:
    """The runs of which they need the figures."""
    return [run for reading in READINGS.values() for run in _figures(reading)]


def _figures(reading: Reading) -> list[Scenario]:
    topologies = [reading.topology(name) for name in TOPOLOGIES]
    return [*transports(reading.transport), *topologies, *safety.head_on(reading).values()]


def examined(store: Store) -> list[Claim]:
    """All claims, those that a reading decides once for each."""
    once = [examine(store) for examine in CLAIMS]
    each = [
        replace(examine(reading, store), reading=reading.title)
        for examine in CLAIMS_BY_READING
        for reading in READINGS.values()
    ]
    return once + each


def _section(store: Store) -> Section:
    rows = [
        [its.claim, its.reading or "both", f"**{its.verdict}**", its.evidence, its.source] for its in examined(store)
    ]
    heading = ["claim", "reading", "verdict", "what decides it", "run"]
    return Section(title="Claims", text=markdown_table(heading, rows))
