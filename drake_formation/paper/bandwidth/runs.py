"""The transports of the study: a soft, wide push, felt by one robot each, and one hand-off state for all graphs.

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
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.paper.runs import ACCURATE, MATERIALS, TOPOLOGIES, topology
from drake_formation.scenario import Scenario, load_scenario, resolve, with_overrides
from drake_formation.simulation import simulate
from drake_formation.vectors import least_length

LAWS = ("hookean", "linear")
GAIN = 2e4
"""δ during transport (N/m), that of Fig. 23."""

PUSH = {"avoidance.range": 8.0, "avoidance.gain": 4.2}
"""ρ0 (m) and η (N m²): inferred, fitted to the tables of the paper."""

GATHERING = {"consensus.law": "linear", "consensus.graph": "complete", "consensus.delta": 5.0}
"""How the robots gather: δ (N/m) inferred."""

DURATIONS = {4: 52.0, 8: 72.0}
"""How long (s): inferred; for other numbers of robots the line's, chosen."""
OTHER_DURATION = 60.0

SPREAD = {"about": [2.5, 3.5], "spread": 2.0}
"""Where robots start for which the paper has no example: as the octagon's, seeded with their number."""


@cache
def formation(robots: int) -> Scenario:
    """Robots in a regular polygon 1 m across, with rubber: for 4 and 8 the paper's own square and octagon."""
    base = load_scenario("quadrilateral" if robots == 4 else "octagon")
    if robots not in DURATIONS:
        shape = {"shape": "polygon", "robots": robots, "side": float(np.tan(np.pi / robots))}
        base = with_overrides(
            base,
            {"formation": shape, "robots.start": {"random": SPREAD | {"seed": robots}}, "name": f"{robots}_robots"},
        )
    return with_overrides(
        base, PUSH | {"avoidance.sensing": "assigned", "avoidance.assigned": nearest_in_formation(resolve(base))}
    )


def nearest_in_formation(formation: Formation) -> list[int]:
    """For each obstacle the number of the robot that passes nearest to it in formation; of equals the front one."""
    ahead = formation.slots @ (formation.goal - formation.centre)
    return [int(np.lexsort((-ahead, distances))[0]) + 1 for distances in np.round(passes(formation), 9).T]


def passes(formation: Formation) -> NDArray[np.float64]:
    """How near each robot's slot comes to each obstacle on the straight way to the goal (m), shape (N, obstacles)."""
    begin = (formation.centre + formation.slots)[:, None] - formation.obstacles[:, :2]
    return least_length(begin, np.broadcast_to(formation.goal - formation.centre, begin.shape))


@cache
def handed_over(robots: int) -> Scenario:
    """The transport alone, from the state in which the gathered robots are at the hand-off."""
    base = formation(robots)
    duration = DURATIONS.get(robots, OTHER_DURATION)
    gathered = simulate(
        with_overrides(base, GATHERING | {"aggregation.duration": duration, "transport.duration": 1e-3}),
        engine="compiled",
    )
    last = gathered.isel(time=int(np.argmax(gathered["phase"].values == 1)))
    velocities = last["velocity"].values.tolist()
    return with_overrides(
        base,
        {
            "aggregation.duration": 0.0,
            "robots.start": last["position"].values.tolist(),
            "robots.velocity": {str(robot): velocity for robot, velocity in enumerate(velocities, start=1)},
            "consensus.delta": GAIN,
        },
    )


def transport(graph: nx.Graph, law: str, material: str = "rubber") -> Scenario:
    """One transport from the shared hand-off.

    Args:
        graph: who talks with whom, robots from 0; without edges each tracks for itself.
        law: of ``LAWS``.
        material: of the object.
    """
    settings = ACCURATE | {"springs.stiffness": MATERIALS[material], "consensus.law": law}
    return with_overrides(handed_over(graph.number_of_nodes()), settings | talk_over(graph))


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
