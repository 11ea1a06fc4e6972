"""The runs of the study as printed, each a scenario: one of the shipped ones with a few fields replaced."""

from functools import cache

from drake_formation.paper.published import published
from drake_formation.scenario import Scenario, load_scenario, with_overrides

FORMATIONS = ("line", "quadrilateral", "octagon")
MATERIALS: dict[str, float] = published()["materials"]
GAINS: tuple[float, ...] = tuple(published()["line"]["consensus_error"]["rubber"])
CASES = [(formation, material, delta) for formation in FORMATIONS for material in MATERIALS for delta in GAINS]
"""The transports of Tables 2-6."""

AGGREGATION_GAINS = (0.0, 1.0, 5.0)
TOPOLOGIES: dict[str, str | list[list[int]]] = {
    "12 channels (complete)": "complete",
    "10 channels": [[1, 2], [1, 4], [2, 3], [2, 4], [3, 4]],
    "8 channels (cycle)": "cycle",
    "6 channels (path)": "path",
    "6 channels (star)": "star",
}
"""Communication graphs of Fig. 22; the paper does not print which three edges its 6 channels are."""


# The virtual springs ring for a thousand radians before the hand-off, and the peak force is read off their phase then.
ACCURATE = {"simulator.accuracy": 1e-8, "simulator.max_step_size": 0.05}

SENSING = {"avoidance.sensing": "nearest"}
"""Sec. 5.1: an obstacle can only be detected by the nearest robot; the shipped scenarios leave it at all in range."""


@cache
def shipped(name: str) -> Scenario:
    """A shipped scenario, read once."""
    return load_scenario(name)


def transport(formation: str, material: str, delta: float) -> Scenario:
    """A cell of Tables 2-6."""
    overrides = {"springs.stiffness": MATERIALS[material], "consensus.delta": delta}
    return with_overrides(shipped(formation), ACCURATE | SENSING | overrides)


def aggregation(formation: str, delta: float) -> Scenario:
    """A curve of Figs. 4-6 and 12-14; the object is not there yet, so its material does not matter."""
    return with_overrides(shipped(formation), ACCURATE | {"consensus.delta": delta})


def topology(name: str) -> Scenario:
    """A bar of Fig. 23."""
    return with_overrides(transport("quadrilateral", "rubber", max(GAINS)), {"consensus.graph": TOPOLOGIES[name]})
