"""The two readings of the paper: as printed, and as probably simulated; and which cells set a parameter of each."""

from collections.abc import Callable
from dataclasses import dataclass

from drake_formation.paper import runs
from drake_formation.paper.readings.simulated import SIMULATED, handed_over
from drake_formation.scenario import Scenario, with_overrides

Run = Callable[[str, str, float], Scenario]
"""A cell's transport, of its formation, material and consensus gain (N/m)."""


@dataclass(frozen=True)
class Place:
    """Where the paper prints a number.

    Attributes:
        formation: shipped scenario.
        quantity: key in ``published.yaml``.
        material: the object's.
        delta: consensus gain (N/m).
    """

    formation: str
    quantity: str
    material: str
    delta: float


@dataclass(frozen=True, kw_only=True)
class Reading:
    """A way to read the paper.

    Attributes:
        title: what the report calls it.
        transport: its runs.
        set_by: the parameter that the number at a place set; such a cell is a calibration and no prediction.
    """

    title: str
    transport: Run
    set_by: Callable[[Place], str]

    def topology(self, name: str) -> Scenario:
        """A bar of Fig. 23."""
        complete = self.transport("quadrilateral", "rubber", max(runs.GAINS))
        return with_overrides(complete, {"consensus.graph": runs.TOPOLOGIES[name]})


def as_probably_simulated(formation: str, material: str, delta: float) -> Scenario:
    """A cell of Tables 2-6 as probably simulated."""
    return handed_over(formation, SIMULATED[formation], material, delta)


def _set_by_both(place: Place) -> str:
    local, rubber = place.delta == 0, place.material == "rubber"
    if place.quantity == "consensus_error" and local and rubber:
        return {"line": "η", "octagon": "octagon"}.get(place.formation, "")
    if place.quantity == "peak_force" and local and (rubber or place.formation == "line"):
        return "D"
    return ""


def _set_as_printed(place: Place) -> str:
    floor = place.delta > 0 or (place.material == "steel" and place.formation != "line")
    return "T_agg" if place.quantity == "consensus_error" and floor else _set_by_both(place)


def _set_as_simulated(place: Place) -> str:
    if place.quantity == "peak_force" and place.delta > 0:
        return "T_agg"
    turned = place.delta > 0 or place.material == "steel"
    if place.formation == "octagon" and place.quantity == "consensus_error" and turned:
        return "who feels"
    return _set_by_both(place)


PRINTED = Reading(title="as printed", transport=runs.transport, set_by=_set_as_printed)
PROBABLE = Reading(title="as probably simulated", transport=as_probably_simulated, set_by=_set_as_simulated)
READINGS = {"printed": PRINTED, "simulated": PROBABLE}
"""By the names that files and commands use."""
