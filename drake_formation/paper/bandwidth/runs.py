"""The transports of the study: as probably simulated, for any number of robots, and one hand-off state for all graphs.

This is the reading of the paper in which communication graphs differ. Each obstacle is felt by the one robot that
passes nearest to it in formation (Sec. 3.4: by the nearest robot), far out and softly. The robots gather with a
consensus gain of their own, so that every transport of as many robots begins in the same state. What they then do with
what they hear is one of two laws: ``linear``, springs on displacements (Eq. 15), or ``hookean``, springs on distances
(the form of Eq. 2).
"""

from functools import cache
from typing import Any

import networkx as nx
import numpy as np

from drake_formation.formation.formation import Formation
from drake_formation.paper.readings.simulated import SIMULATED, Settings, carried_on, passes
from drake_formation.paper.runs import TOPOLOGIES, shipped, topology
from drake_formation.scenario import Scenario, resolve, with_overrides

LAWS = ("hookean", "linear")
GAIN = 2e4
"""δ during transport (N/m), that of Fig. 23."""

DURATIONS = {8: 72.0}
"""How long the robots gather (s): inferred; for other numbers than this and the paper's four the line's, chosen."""
OTHER_DURATION = SIMULATED["line"].duration

SPREAD = {"about": [2.5, 3.5], "spread": 2.0}
"""Where robots start for which the paper has no example: as the octagon's, seeded with their number."""


@cache
def formation(robots: int) -> Scenario:
    """Robots in a regular polygon 1 m across, with rubber: for 4 and 8 the paper's own square and octagon."""
    if robots == 4:
        return shipped("quadrilateral")
    if robots == 8:
        return shipped("octagon")
    shape = {"shape": "polygon", "robots": robots, "side": float(np.tan(np.pi / robots))}
    return with_overrides(
        shipped("octagon"),
        {"formation": shape, "robots.start": {"random": SPREAD | {"seed": robots}}, "name": f"{robots}_robots"},
    )


def settings(robots: int) -> Settings:
    """How as many robots are simulated: four as in the tables; others likewise, felt by the nearest robot."""
    if robots == 4:
        return SIMULATED["quadrilateral"]
    return Settings(
        duration=DURATIONS.get(robots, OTHER_DURATION), assigned=nearest_in_formation(resolve(formation(robots)))
    )


def nearest_in_formation(formation: Formation) -> tuple[int, ...]:
    """For each obstacle the number of the robot that passes nearest to it in formation; of equals the front one."""
    ahead = formation.slots @ (formation.goal - formation.centre)
    return tuple(int(np.lexsort((-ahead, distances))[0]) + 1 for distances in np.round(passes(formation), 9).T)


@cache
def handed_over(robots: int) -> Scenario:
    """The transport alone, from the state in which the gathered robots are at the hand-off."""
    return carried_on(formation(robots), settings(robots), "rubber", GAIN)


def transport(graph: nx.Graph, law: str) -> Scenario:
    """One transport from the shared hand-off.

    Args:
        graph: who talks with whom, robots from 0; without edges each tracks for itself.
        law: of ``LAWS``.
    """
    return with_overrides(handed_over(graph.number_of_nodes()), {"consensus.law": law} | talk_over(graph))


def figure_23() -> dict[str, nx.Graph]:
    """The communication graphs of Fig. 23, by name, after none."""
    named = {name: resolve(topology(name)).channels.graph for name in TOPOLOGIES}
    return {"local LQR": nx.empty_graph(4)} | named


def talk_over(graph: nx.Graph) -> dict[str, Any]:
    """What to set for a graph of channels: all robots have channels, which count or do not: one diagram for all graphs.

    Without any that counts there is no consensus.
    """
    robots = graph.number_of_nodes()
    channels = [
        {"speaker": j + 1, "listener": i + 1, "weight": float(graph.has_edge(i, j))}
        for i in range(robots)
        for j in range(robots)
        if i != j
    ]
    alone = {} if graph.number_of_edges() else {"consensus.delta": 0.0}
    return {"consensus.graph": channels} | alone
