"""Where and when robots touch obstacles or each other with their footprints, between samples too."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.scenario import resolve
from drake_formation.simulation.events import Event
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.series import Series
from drake_formation.vectors import length_of

Array = NDArray[np.float64]
Gaps = Callable[[Array, Array], Array]
"""Distance of the surfaces of each pair (m), shape (..., pairs), by time (s) and positions of the robots (m)."""

COLLISION = "collision"
"""The kind of event that a contact begins."""

CUTS = 32
FINE = 1e-6
"""Share of a step below which it is not cut any more."""


@dataclass(frozen=True)
class _Pairs:
    """Pairs of bodies that may touch.

    Attributes:
        gaps: the distances of their surfaces.
        robots: of each pair the robots that move, from 0, shape (pairs, 1 or 2).
        speed: how fast anything else in it moves at the most (m/s).
        meeting: the event that a pair touches, by its index, time (s) and the positions of all robots (m).
    """

    gaps: Gaps
    robots: NDArray[np.intp]
    speed: float
    meeting: Callable[[int, float, Array], Event]


def collisions(series: Series) -> list[Event]:
    """Every contact of a robot with an obstacle, during transport, or with another robot, as it begins.

    A robot without a footprint is a point, which touches obstacles and robots that have one, and no other point.

    Args:
        series: a run.

    Returns:
        In the order of their times; what touches from the start, or when obstacles come into play, does so then.
    """
    formation, phase = resolve(series.scenario), series["phase"]
    found: list[Event] = []
    among_robots = _among_robots(formation)
    carried_on = np.zeros(len(among_robots.robots), dtype=bool)
    for part in (0, 1):  # accelerations jump in between
        chosen = phase == part
        if chosen.any():
            arrays = (series[name][chosen] for name in ("position", "velocity", "acceleration"))
            motion = Motion(series["time"][chosen], *arrays).with_samples_at(formation.obstacles.turns)
            found += _beginnings(motion, among_robots, carried_on)
            carried_on = among_robots.gaps(motion.times[-1:], motion.position[-1:])[0] <= 0
            if part:
                around = _with_obstacles(formation)
                found += _beginnings(motion, around, np.zeros(len(around.robots), dtype=bool))
    return sorted(found, key=lambda event: event.time)


def _touching(time: float, place: tuple[float, float], who: tuple[int, ...], what: str) -> Event:
    x, y = place
    return Event(COLLISION, time, (float(x), float(y)), who, f"robot {who[0]} touches {what}")


def _among_robots(formation: Formation) -> _Pairs:
    radii = formation.footprints
    first, second = np.triu_indices(formation.robots, k=1)
    bodies = radii[first] + radii[second] > 0
    first, second = first[bodies], second[bodies]

    def gaps(_times: Array, position: Array) -> Array:
        return length_of(position[..., first, :] - position[..., second, :]) - (radii[first] + radii[second])

    def meeting(pair: int, time: float, position: Array) -> Event:
        i, j = int(first[pair]), int(second[pair])
        x, y = position[i] + (position[j] - position[i]) * radii[i] / (radii[i] + radii[j])
        return _touching(time, (x, y), (i + 1, j + 1), f"robot {j + 1}")

    return _Pairs(gaps, np.column_stack([first, second]), 0.0, meeting)


def _with_obstacles(formation: Formation) -> _Pairs:
    obstacles, radii = formation.obstacles, formation.footprints
    robot, obstacle = (indices.ravel() for indices in np.indices((formation.robots, len(obstacles))))

    def gaps(times: Array, position: Array) -> Array:
        clearance = obstacles.clearance(position, times[..., None]) - radii[:, None]
        return clearance.reshape(*position.shape[:-2], -1)

    def meeting(pair: int, time: float, position: Array) -> Event:
        i, k = int(robot[pair]), int(obstacle[pair])
        away = obstacles.away(position[i], time)[0][k]
        x, y = position[i] - radii[i] * away / max(float(np.hypot(*away)), np.finfo(float).tiny)
        return _touching(time, (x, y), (i + 1,), f"obstacle {k + 1}")

    speed = max((item.top_speed for item in obstacles), default=0.0)
    return _Pairs(gaps, robot[:, None], speed, meeting)


def _beginnings(motion: Motion, pairs: _Pairs, carried_on: NDArray[np.bool_]) -> Iterator[Event]:
    """The contacts that begin in a motion; those that are carried on from before it do not."""
    if not len(pairs.robots):
        return
    times, position = motion.times, motion.position
    gap = pairs.gaps(times, position)
    for pair in np.flatnonzero((gap[0] <= 0) & ~carried_on).tolist():
        yield pairs.meeting(pair, float(times[0]), position[0])
    bulge = motion.bulge()[:, pairs.robots].sum(axis=-1)
    least = _least(gap, position, pairs, np.diff(times)[:, None], bulge)
    looked_into = np.isfinite(least)  # not where a run diverges so far that squares of its numbers overflow
    for step, pair in np.argwhere((gap[:-1] > 0) & (least <= 0) & looked_into).tolist():
        share = _first_share(motion, pairs, step, pair, (0.0, 1.0), float(bulge[step, pair]))
        if share is not None:
            time = float(times[step] + share * (times[step + 1] - times[step]))
            place, _, _ = motion.at(np.array([step]), np.array([[share]]))
            yield pairs.meeting(pair, time, place[0, 0])


def _least(gap: Array, position: Array, pairs: _Pairs, lengths: Array, bulge: Array | float) -> Array:
    """What the gaps are no less than from one sample to the next (m), shape (samples − 1, pairs).

    Nothing that moves by some way changes its distance from anything by more.
    """
    chord = length_of(np.diff(position, axis=0))[:, pairs.robots].sum(axis=-1)
    way = chord + 2.0 * bulge + pairs.speed * lengths
    least: Array = 0.5 * (gap[:-1] + gap[1:] - way)
    return least


def _first_share(
    motion: Motion, pairs: _Pairs, step: int, pair: int, within: tuple[float, float], bulge: float
) -> float | None:
    """How much of a step has passed when a pair first touches, or None.

    Args:
        motion: of the robots.
        pairs: the pairs.
        step: index of the sample before.
        pair: which pair.
        within: from where to where to look, as shares of the step.
        bulge: how far the pair's robots leave the chord from there to there at the most (m).
    """
    share, bulge = np.linspace(*within, CUTS + 1), bulge / CUTS**2
    position = motion.at(np.array([step]), share[None])[0][0]
    length = motion.times[step + 1] - motion.times[step]
    gap = pairs.gaps(motion.times[step] + share * length, position)
    least = _least(gap, position, pairs, np.diff(share)[:, None] * length, bulge)[:, pair]
    for part in np.flatnonzero((least <= 0) | (gap[1:, pair] <= 0)).tolist():
        if within[1] - within[0] > FINE:
            found = _first_share(motion, pairs, step, pair, (float(share[part]), float(share[part + 1])), bulge)
            if found is not None:
                return found
        elif gap[part + 1, pair] <= 0:
            return float(share[part + 1])
    return None
