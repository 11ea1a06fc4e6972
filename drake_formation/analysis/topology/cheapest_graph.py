"""The cheapest communication graph that keeps the consensus error below a bound, and what every channel buys.

This is the paper's closing question on bandwidth (Sec. 5.4). A scenario's communication graph is connected, so only
connected graphs are considered, although a loose bound may be met by local control alone.

Why 10 channels perform as 12 for four robots: the Laplacian's eigenvalues are 2, 4, 4 instead of 4, 4, 4, and without
δ_v these move the frequencies of the relative modes only; all decay at d/2m. What is left at the hand-off, which is the
error that the paper measures, is therefore the same to a per cent, with 8 channels (2, 2, 4) as with 10, and with the
best 6. An obstacle's blow is another matter: the worst error follows the fewest neighbours of any robot, so that 10
channels (where two robots have two) are as good as 8, and a quarter worse than 12.
"""

import numpy as np

from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.response.error_criteria import ForceNoise, HandOff, Measure, Pulse, Vibration
from drake_formation.analysis.topology.results import CheapestGraph, GraphPoint, ParetoFront
from drake_formation.analysis.topology.study import GraphStudy

__all__ = [
    "CheapestGraph",
    "ForceNoise",
    "GraphPoint",
    "HandOff",
    "Measure",
    "ParetoFront",
    "Pulse",
    "Vibration",
    "cheapest_graph",
    "pareto_front",
]

EXHAUSTIVE = 3000
"""Graphs up to which all are tried."""


def cheapest_graph(
    formation: LinearFormation, *, error_bound_m: float, measure: Measure | None = None, exhaustive: int = EXHAUSTIVE
) -> CheapestGraph:
    """The connected communication graph with the fewest channels that keeps a consensus error below a bound.

    Where there are few enough graphs all are tried, from trees upwards: up to isomorphism if the robots can be swapped
    (to 7 of them), otherwise up to the formation's own symmetries (to 6). Beyond, the graph comes from a search, and
    :mod:`.graph_bounds` says how many channels it takes at least. An error costs some N³ (a millisecond for four
    robots, 0.2 s for thirty), and a search computes 60 of them at most.

    Args:
        formation: the linearized formation; its own graph plays no part.
        error_bound_m: what the error may be (m).
        measure: which error; by default that of a force with an impulse of 1 N s on any one robot.
        exhaustive: the most graphs to try one by one.

    Raises:
        IllPosedError: no graph meets the bound, the loop is not stable, or there is one robot only.
    """
    study = GraphStudy(formation, measure or Pulse(), exhaustive)
    if study.all_graphs is None:
        return study.searched(error_bound_m)
    return study.proven(error_bound_m, study.all_graphs)


def pareto_front(
    formation: LinearFormation, *, measure: Measure | None = None, exhaustive: int = EXHAUSTIVE
) -> ParetoFront:
    """The least consensus error for every number of channels, from a tree to the complete graph.

    Args:
        formation: the linearized formation; its own graph plays no part.
        measure: which error; by default that of a force with an impulse of 1 N s on any one robot.
        exhaustive: the most graphs to try one by one; beyond, a couple of dozen numbers of edges are searched.

    Raises:
        IllPosedError: the loop is not stable, or there is one robot only.
    """
    study = GraphStudy(formation, measure or Pulse(), exhaustive)
    if study.all_graphs is None:
        points = tuple(study.search(edges) for edges in study.some_edges())
        proof = "a search; bounds by the number of neighbours" if study.bounded else "a search, without bounds"
    else:
        points = tuple(study.best(candidates, every=True) for candidates in study.all_graphs.values())
        proof = study.words.format(len(study.tried))
    return ParetoFront(points, str(study.measure), study.all_graphs is not None, proof, np.array(study.tried))
