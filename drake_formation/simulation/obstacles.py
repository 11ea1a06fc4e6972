"""Whether a run took its obstacles seriously: none entered, none leapt over, none handed to and fro without end."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.scenario import Scenario, resolve
from drake_formation.simulation.recorder import Recording
from drake_formation.vectors import least_from_segment, least_length, length_of

Array = NDArray[np.float64]

SHARE = 0.25
"""How far a robot may move in one step, as a share of the distance from which it feels an obstacle's centre."""

CHATTER = 100
"""Changes of the robot that is nearest to an obstacle; a formation that passes it has a few."""


@dataclass(frozen=True)
class Leap:
    """A step in which a robot passes so much of an obstacle's range that the integrator may overlook it.

    Attributes:
        time: when it begins (s).
        robot: which robot, from 1.
        obstacle: which obstacle, from 1.
        longest: a step that would be short enough (s), at most half of this one.
    """

    time: float
    robot: int
    obstacle: int
    longest: float


@dataclass(frozen=True)
class Hit:
    """A robot inside an obstacle, or on its edge.

    Attributes:
        time: when first (s).
        robot: which robot, from 1.
        obstacle: which obstacle, from 1.
    """

    time: float
    robot: int
    obstacle: int


def first_hit(scenario: Scenario, recording: Recording) -> Hit | None:
    """The first sample of the transport in which a robot, without its footprint, is inside an obstacle, or None."""
    obstacles, position = resolve(scenario).obstacles, recording.series("state")[..., :2]
    with np.errstate(over="ignore"):
        clearance = obstacles.clearance(position, recording.times[:, None])
    hits = np.argwhere((clearance <= 0.0) & (recording.phases == 1)[:, None, None])
    if not len(hits):
        return None
    sample, robot, obstacle = hits[0].tolist()
    return Hit(float(recording.times[sample]), robot + 1, obstacle + 1)


def worst_leap(scenario: Scenario, recording: Recording) -> Leap | None:
    """The leap that asks for the shortest steps, or None where all steps near obstacles were short enough.

    An integrator looks at the force a few times in a step. Where the whole range of an obstacle, or its solid inside,
    lies between two looks, nothing tells it that there was something to feel.

    Args:
        scenario: what ran.
        recording: every step of the run; where it ended early, the longest step is taken to have come next.
    """
    times, state = recording.times, recording.series("state")
    steps = np.append(np.diff(times), scenario.simulator.max_step_size)
    position = state[..., :2]
    move = steps[:, None, None] * state[..., 2:]
    lengths = _lengths(position, move)
    transport = (recording.phases == 1)[:, None]
    worst = None
    formation = resolve(scenario)
    for number, obstacle in enumerate(formation.obstacles, start=1):
        reach = obstacle.radius + formation.sensing_ranges
        if formation.footprints.any():
            reach = reach + formation.footprints
        place, way, (length, moved) = position, move, lengths
        if len(obstacle.motion):
            drift = obstacle.displacement(np.append(times, times[-1] + steps[-1]))[:, None]
            place, way = position - drift[:-1], move - np.diff(drift, axis=0)
            length, moved = _lengths(place, way)
        edges = zip(*obstacle.edges(), strict=True)
        near = np.logical_or.reduce([_least_distance(place - begin, way, extent) < reach for begin, extent in edges])
        for sample, robot in np.argwhere(transport & near & (np.maximum(length, moved) > SHARE * reach)):
            own = SHARE * reach[robot]
            shorter = own / max(length[sample, robot], 2.0 * own)
            longest = float(steps[sample] * shorter)
            if worst is None or longest < worst.longest:
                worst = Leap(float(times[sample]), int(robot) + 1, number, longest)
    return worst


def chattering(scenario: Scenario, clearance: Array) -> str:
    """What to say of obstacles that robots at the same distance see in turns, or nothing.

    Where each is pushed away as soon as it is the nearest, the turns become as short as the integrator's steps.

    Args:
        scenario: what ran.
        clearance: of every robot from every obstacle during transport (m), shape (samples, N, obstacles).
    """
    fields = resolve(scenario).parts["avoidance"]
    at_once = [field for field in fields if getattr(field, "masked", False) and not field.margin]
    masked = [field.config for field in at_once if field.config.gain > 0.0]
    if not masked or not clearance.size:
        return ""
    felt = clearance.min(axis=1)[1:] < max(field.range for field in masked)
    changes = ((np.diff(np.argmin(clearance, axis=1), axis=0) != 0) & felt).sum(axis=0)
    if changes.max() < CHATTER:
        return ""
    return (
        f"Obstacle {int(np.argmax(changes)) + 1} was seen by another robot {int(changes.max())} times: robots are "
        "equally near to it, and each is pushed away as soon as it is the nearest. Such a run takes very short steps. "
        "Try avoidance.sensing=in_range, avoidance.margin=0.1, or another place for the obstacle or the goal."
    )


def _lengths(position: Array, move: Array) -> tuple[Array, Array]:
    """How long the moves ahead are and how long those were that came (m), two of shape (samples, N)."""
    with np.errstate(over="ignore"):
        length, moved = length_of(move), np.zeros(move.shape[:-1])
        moved[:-1] = length_of(np.diff(position, axis=0))  # more where the step went through an obstacle
    return length, moved


def _least_distance(offset: Array, move: Array, extent: Array) -> Array:
    """How near the way from an offset along a move comes to a segment from the origin (m), shape (..., N)."""
    with np.errstate(over="ignore", invalid="ignore"):  # a run that diverged may end in numbers whose squares overflow
        return least_from_segment(offset, move, extent) if extent.any() else least_length(offset, move)
