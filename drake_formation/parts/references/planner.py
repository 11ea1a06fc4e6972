"""A way around known obstacles, planned by an artificial potential field before the run.

The formation centre flows down the potential U = ‖p − goal‖ + Σ ½ η (1/ρ − 1/ρ0)², the second part Khatib's (1986) for
every known obstacle nearer than ρ0. An obstacle is grown by the radius of the formation, so that ρ is the clearance of
the robots, however they stand.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydrake.trajectories import PiecewisePolynomial

from drake_formation.formation.obstacles import Obstacles
from drake_formation.parts.references.waypoints import chord_shares, waypoint_trajectory
from drake_formation.vectors import least_from_segment, turned_left

Array = NDArray[np.float64]

PIECES = 20
"""Pieces of the smooth trajectory, as many for every plan: only then do two plans differ in numbers alone."""

SAMPLES = 20
"""Samples of a plan for every piece, and half the width of the averages that round its corners."""

STEP = 0.05
"""Step down the field within range of an obstacle, as a share of the clearance."""

MOST_STEPS = 20_000
PATIENCE = 100
"""Steps after which a flow that has come no lower is stuck."""


class StuckError(ValueError):
    """The flow ended before the goal, in a local minimum of the field.

    Attributes:
        place: where (m), shape (2,).
    """

    def __init__(self, place: Array) -> None:
        super().__init__(f"the flow is stuck at {place.tolist()}")
        self.place = place


@dataclass(frozen=True)
class PotentialField:
    """The potential of a goal and of known obstacles.

    Attributes:
        goal: where the attraction of unit strength pulls to (m), shape (2,).
        obstacles: the known obstacles, grown by the formation's radius; none moves.
        clearance: where the repulsion balances the attraction (m), so that no flow comes nearer to a single obstacle.
        reach: ρ0, beyond which nothing is felt (m), above the clearance. An obstacle near the goal reaches no farther
            than the goal, which so remains a minimum; the goal must be farther than the clearance from it.
    """

    goal: Array
    obstacles: Obstacles
    clearance: float
    reach: float

    def reaches(self) -> Array:
        """ρ0 of every obstacle (m), shape (obstacles,)."""
        result: Array = np.minimum(self.reach, clearances(self.goal, self.obstacles))
        return result

    def gains(self) -> Array:
        """η of every obstacle (m³): the repulsion η (1/ρ − 1/ρ0)/ρ² is 1 where ρ is the clearance."""
        result: Array = self.clearance**2 / (1 / self.clearance - 1 / self.reaches())
        return result


def plan(start: ArrayLike, field: PotentialField) -> Array:
    """The way of the formation centre down the field, as a polygonal line.

    An obstacle straight ahead leaves the flow on the ridge between the two ways around it. It starts a thousandth of
    the clearance to the left of the line to the goal: any disturbance would decide, this one always alike.

    Args:
        start: where it begins (m), shape (2,), outside all obstacles.
        field: the potential.

    Returns:
        Points from the start to the goal (m), shape (points, 2).

    Raises:
        StuckError: the flow ends before the goal.
    """
    reaches, gains = field.reaches(), field.gains()
    begin = np.asarray(start, dtype=float)
    if np.array_equal(begin, field.goal):
        return np.array([begin, field.goal])
    way = field.goal - begin
    point = begin + 1e-3 * field.clearance * turned_left(way) / np.linalg.norm(way)
    path, lowest, wasted = [begin], np.inf, 0
    for _ in range(MOST_STEPS):
        # Outside all reaches the flow is straight: one step leads to the next of them.
        outside = (clearances(point, field.obstacles) - reaches).min(initial=np.inf)
        step = max(STEP * field.clearance, float(outside))
        if np.linalg.norm(field.goal - point) <= step:
            return np.array([*path, field.goal])
        potential, force = _potential(point, field, reaches, gains)
        wasted = 0 if potential < lowest else wasted + 1
        lowest = min(lowest, potential)
        strength = np.linalg.norm(force)
        if wasted > PATIENCE or strength == 0:
            break
        point = point + step * force / strength
        path.append(point)
    raise StuckError(point)


def plan_trajectory(path: Array, field: PotentialField, duration: float) -> PiecewisePolynomial:
    """A plan as a smooth trajectory from rest to rest.

    The flow turns sharply where it meets an obstacle straight ahead. Two moving averages along the way round its
    corners; where they cut into a clearance, the way is pushed out again. A curve is laid through points at equal
    distances.

    Args:
        path: from :func:`plan`: points (m), shape (points, 2), of which not all are one.
        field: in which it was planned.
        duration: how long it takes (s).

    Returns:
        Position (m, shape (2, 1)) over the time since the start (s), in ``PIECES`` pieces.
    """
    marks = np.linspace(0.0, 1.0, SAMPLES * PIECES + 1)
    even = np.column_stack([np.interp(marks, chord_shares(path), axis) for axis in path.T])
    for _ in range(2):
        even = _pushed_clear(_averaged(even, SAMPLES), field)
    return waypoint_trajectory(even[::SAMPLES], duration)


def _averaged(points: Array, reach: int) -> Array:
    """Mean of every point and as many on either side; continued beyond the ends by their images, which hold them."""
    before, after = 2 * points[0] - points[reach:0:-1], 2 * points[-1] - points[-2 : -2 - reach : -1]
    sums = np.cumsum(np.vstack([np.zeros((1, 2)), before, points, after]), axis=0)
    result: Array = (sums[2 * reach + 1 :] - sums[: -2 * reach - 1]) / (2 * reach + 1)
    return result


def _pushed_clear(points: Array, field: PotentialField) -> Array:
    """Points pushed straight out of the obstacles to the clearance, one obstacle after the other."""
    for k in range(len(field.obstacles)):
        vectors, surfaces = field.obstacles.chosen([k]).away(points)
        away = vectors[:, 0]
        lengths = np.hypot(*away.T)[:, None]
        missing = np.maximum(field.clearance + surfaces - lengths, 0.0)
        points = points + missing * away / np.maximum(lengths, np.finfo(float).tiny)
    return points


def clearances(point: ArrayLike, obstacles: Obstacles) -> Array:
    """Distance of points from every obstacle (m), shape (..., obstacles); negative inside."""
    away, surfaces = obstacles.away(point)
    result: Array = np.hypot(away[..., 0], away[..., 1]) - surfaces
    return result


def closest(path: Array, obstacles: Obstacles) -> Array:
    """Least distance of a polygonal line from every obstacle (m), between its points too; shape (obstacles,).

    Not below minus the radius where it crosses a segment or a polygon's edge.
    """
    begin, way = path[:-1, None], np.diff(path, axis=0)[:, None]
    begins, extents = obstacles.edges
    apart = least_from_segment(begin - begins, np.broadcast_to(way, (len(way), len(begins), 2)), extents).min(axis=0)
    result = np.full(len(obstacles), np.inf)
    np.minimum.at(result, obstacles.edge_owners, apart)
    return result - obstacles.radii


def _potential(point: Array, field: PotentialField, reaches: Array, gains: Array) -> tuple[float, Array]:
    """Potential (m) and the force down it, shape (2,)."""
    to_goal = field.goal - point
    distance = np.linalg.norm(to_goal)
    away, surfaces = field.obstacles.away(point)
    from_centre = np.hypot(*away.T)
    clearance = from_centre - surfaces
    slope = np.maximum(1 / clearance - 1 / reaches, 0.0)
    push = gains * slope / clearance**2
    force: Array = to_goal / distance + (push / from_centre) @ away
    return float(distance + (0.5 * gains * slope**2).sum()), force
