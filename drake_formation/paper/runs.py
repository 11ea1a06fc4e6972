"""The runs of the study, each a scenario: one of the shipped ones with a few fields replaced."""

from drake_formation.scenario import Scenario, load_scenario, with_overrides

FORMATIONS = ("line", "quadrilateral", "octagon")
MATERIALS = {"rubber": 1.45, "steel": 3e4}
GAINS = (0.0, 1e4, 2e4)
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
ACCURATE = {"simulator.accuracy": 1e-9, "simulator.max_step_size": 0.05}


def transport(formation: str, material: str, delta: float) -> Scenario:
    """A cell of Tables 2-6."""
    overrides = {"springs.stiffness": MATERIALS[material], "consensus.delta": delta}
    return load_scenario(formation, overrides=ACCURATE | overrides)


def transports(formation: str) -> list[Scenario]:
    """All cells of a formation's tables."""
    return [transport(formation, material, delta) for material in MATERIALS for delta in GAINS]


def aggregation(formation: str, delta: float) -> Scenario:
    """A curve of Figs. 4-6 and 12-14; the object is not there yet, so its material does not matter."""
    return load_scenario(formation, overrides=ACCURATE | {"consensus.delta": delta})


def topology(name: str) -> Scenario:
    """A bar of Fig. 23."""
    return with_overrides(transport("quadrilateral", "rubber", 2e4), {"consensus.graph": TOPOLOGIES[name]})
