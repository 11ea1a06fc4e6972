"""One formation on many communication graphs, from a single linearization."""

from dataclasses import replace
from itertools import pairwise, permutations

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import STATES, LinearFormation, linearize
from drake_formation.formation import graphs
from drake_formation.scenario import with_overrides

Array = NDArray[np.float64]
Renumbering = tuple[int, ...]
"""Where each robot goes: robot i takes the number π(i), from 0."""

MOST_RENUMBERED = 6
"""Robots up to which every renumbering is tried where they are not all alike."""


def with_all_channels(formation: LinearFormation) -> LinearFormation:
    """The same formation with a channel each way between any two robots."""
    return linearize(with_overrides(formation.scenario, {"consensus.graph": "complete"}))


def with_channels(complete: LinearFormation, graph: nx.Graph) -> LinearFormation:
    """A formation with the channels of a graph only.

    Consensus is a sum over channels, each of which vanishes in agreement: a robot's own part of it is minus what it
    hears. So the channels of any graph are picked from those of the complete one.

    Args:
        complete: the formation on the complete graph.
        graph: who talks, robots from 0.
    """
    adjacency = nx.to_numpy_array(graph, nodelist=range(complete.robots))
    edges = tuple((i + 1, j + 1) for i, j in graphs.edges(graph))
    consensus = complete.scenario.consensus.model_copy(update={"graph": edges})
    return replace(
        complete,
        scenario=complete.scenario.model_copy(update={"consensus": consensus}),
        per_delta=_picked(complete.per_delta, adjacency),
        per_delta_v=_picked(complete.per_delta_v, adjacency),
    )


def interchangeable(complete: LinearFormation) -> bool:
    """Whether any two robots can be swapped without anything changing.

    So it is for equal robots without springs, or with equal linear springs between all. Then only the shape of the
    communication graph counts, not which robot has which place in it.
    """
    robots = range(complete.robots)
    swaps = [[*robots[:i], j, i, *robots[j + 1 :]] for i, j in pairwise(robots)]
    return all(_unchanged(complete, tuple(swap), np.eye(2)) for swap in swaps)


def renumberings(complete: LinearFormation) -> list[Renumbering]:
    """Renumberings that, with a rotation or reflection of the plane, change nothing: a square has eight.

    Two communication graphs that one of them maps onto each other serve equally well. Every one is verified on the
    matrices; for more than ``MOST_RENUMBERED`` robots only the identity is returned.
    """
    robots = range(complete.robots)
    if complete.robots > MOST_RENUMBERED:
        return [tuple(robots)]
    slots = complete.resolved.slots
    return [way for way in permutations(robots) if any(_unchanged(complete, way, turn) for turn in _turns(slots, way))]


def _picked(part: Array, adjacency: Array) -> Array:
    robots = len(adjacency)
    heard = part.reshape(robots, STATES, robots, STATES) * adjacency[:, None, :, None]
    itself = np.arange(robots)
    heard[itself, :, itself, :] = -heard.sum(axis=2)
    result: Array = heard.reshape(part.shape)
    return result


def _turns(slots: Array, renumbering: Renumbering) -> list[Array]:
    """Rotations and reflections that may carry every slot to that of its new number."""
    left, _, right = np.linalg.svd(slots[list(renumbering)].T @ slots)
    mirror = np.diag([1.0, -1.0])
    return [left @ right, left @ mirror @ right, np.eye(2), -np.eye(2), mirror, -mirror]


def _unchanged(formation: LinearFormation, renumbering: Renumbering, turn: Array) -> bool:
    order = np.eye(formation.robots)[list(renumbering)].T
    forces = np.kron(order, turn)
    states = np.kron(order, np.kron(np.eye(2), turn))
    loop = (formation.tracking + formation.springs, formation.per_delta, formation.per_delta_v)
    return all(_same(states @ part @ states.T, part) for part in loop) and _same(
        states @ formation.B @ forces.T, formation.B
    )


def _same(one: Array, other: Array) -> bool:
    return bool(np.abs(one - other).max() <= 1e-9 * np.abs(other).max())
