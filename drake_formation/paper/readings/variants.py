"""Readings beside the two: what each ingredient of the probable one is worth, and others that explain as much."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

from drake_formation.paper import runs
from drake_formation.paper.quantities import largest_robot
from drake_formation.paper.readings.fit import fit
from drake_formation.paper.readings.simulated import SIMULATED, BySettings, changed, handed_over
from drake_formation.paper.readings.two_readings import PRINTED, PROBABLE, Run
from drake_formation.paper.store import Store
from drake_formation.paper.tables import Entry, all_entries
from drake_formation.scenario import Scenario, with_overrides

RANGES = (4.0, 6.0, 8.0, 12.0)
"""Widths of the field ρ0 that are tried (m), each with η fitted anew."""

UNCOUPLED = {"line": 65.0, "quadrilateral": 47.0, "octagon": 50.0}
"""T_agg (s) with δ = 0 while the robots gather, fitted to the forces."""

FRONT = {"line": (2, 1), "quadrilateral": (4, 3), "octagon": (8, 5)}
"""Which robot passes each obstacle nearest in formation, of equals the front one."""

LAWS: dict[str, dict[str, str]] = {
    "lines for N > 2": {name: its.law for name, its in SIMULATED.items()},
    "lines for every N": dict.fromkeys(SIMULATED, "hookean"),
    "displacements for every N": dict.fromkeys(SIMULATED, "linear"),
}


@dataclass(frozen=True)
class Variant:
    """A way to have simulated the tables.

    Attributes:
        run: its transports.
        largest: whether Table 4 is read as the largest robot's error, instead of all robots' together.
    """

    run: Run
    largest: bool = False

    def entries(self, store: Store) -> list[Entry]:
        """All published numbers beside its own."""
        return all_entries(store, self.run, {"Table 4": largest_robot} if self.largest else {})


def by(settings: BySettings) -> Run:
    """Transports from the hand-off on."""
    return lambda formation, material, delta: handed_over(formation, settings[formation], material, delta)


def in_range(formation: str, material: str, delta: float) -> Scenario:
    """A transport as printed, but that every robot in range feels an obstacle, as in the shipped scenarios."""
    return with_overrides(PRINTED.transport(formation, material, delta), {"avoidance.sensing": "in_range"})


@cache
def ingredients() -> Mapping[str, Variant]:
    """The probable reading without one of its ingredients, or with another in its place."""
    hard = runs.shipped("line").avoidance
    gathered = {name: runs.shipped(name).aggregation.duration for name in runs.FORMATIONS}
    times = ", ".join(f"{duration:g}" for duration in gathered.values())
    uncoupled = ", ".join(f"{duration:g}" for duration in UNCOUPLED.values())
    return {
        PROBABLE.title: Variant(PROBABLE.transport),
        f"a: hard, short push (ρ0 = {hard.range:g} m, η = {hard.gain:g} N m²)": Variant(
            by(changed(range=hard.range, gain=hard.gain))
        ),
        "b: felt by the nearest robot at each instant": Variant(by(changed(sensing="nearest"))),
        "b: felt by every robot in range": Variant(by(changed(sensing="in_range"))),
        "b: in the octagon by the front one of equals": Variant(by(changed(assigned=FRONT))),
        "c: Table 4 is the largest robot's ‖ε_i‖": Variant(PROBABLE.transport, largest=True),
        "d: robots gather with the δ of the transport": Variant(by(changed(gathering_gain=None))),
        f"d: T_agg = {times} s": Variant(by(changed(duration=gathered))),
        f"d: robots gather without consensus, T_agg = {uncoupled} s": Variant(
            by(changed(gathering_gain=0.0, duration=UNCOUPLED))
        ),
        "e: springs along lines for every N": Variant(by(changed(law=LAWS["lines for every N"]))),
        "e: springs on displacements for every N": Variant(by(changed(law=LAWS["displacements for every N"]))),
        PRINTED.title: Variant(PRINTED.transport),
        f"{PRINTED.title}, felt by every robot in range": Variant(in_range),
        f"{PRINTED.title}, felt by every robot in range, Table 4 the largest robot's": Variant(in_range, largest=True),
    }


@cache
def alternatives() -> Mapping[tuple[str, float, float], BySettings]:
    """Settings that might explain as much, by law, ρ0 (m) and δ while gathering (N/m); η is fitted to the line's."""
    found: dict[tuple[str, float, float], BySettings] = {}
    for name, laws in LAWS.items():
        for width in RANGES:
            found[name, width, SIMULATED["line"].gathering_gain or 0.0] = fitted(changed(law=laws, range=width))
        found[name, SIMULATED["line"].range, 0.0] = fitted(changed(law=laws, gathering_gain=0.0, duration=UNCOUPLED))
    return found


def fitted(settings: BySettings) -> BySettings:
    """Settings with η fitted to the line's error alone; its law plays no part at δ = 0."""
    line = replace(settings["line"], law=SIMULATED["line"].law, gain=SIMULATED["line"].gain)
    return changed(settings, gain=fit(line).gain)
