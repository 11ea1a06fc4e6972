"""How near robots come to obstacles while they carry the object."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.simulation.extremes import Vectors, shortest
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.series import Series
from drake_formation.vectors import length_of

Array = NDArray[np.float64]


def least_clearance(robots: Motion, bulge: Array, centres: Array, radii: Array) -> float | None:
    """Least distance of any robot to any obstacle at any time (m), negative inside; None without obstacles.

    Args:
        robots: their motion.
        bulge: of that motion (m).
        centres: of the obstacles (m), shape (obstacles, 2).
        radii: of the obstacles (m), shape (obstacles,).
    """
    if not len(radii):
        return None
    return float(shortest(_pairs(robots, bulge, centres), np.tile(radii, robots.position.shape[1]))[0])


def contact(series: Series) -> tuple[float, int, int] | None:
    """Where a robot is inside an obstacle during transport.

    Returns:
        The time of the first sample inside one, or of the one nearest to it where only what lies between samples is
        (s); the robot and the obstacle, from 0. None where all keep clear.
    """
    carried = series["phase"] == 1
    times, clearance = series["time"][carried], series["clearance"][carried]
    inside = np.argwhere(clearance <= 0)
    if len(inside):
        sample, robot, obstacle = inside[0].tolist()
        return float(times[sample]), robot, obstacle
    motion = Motion(times, *(series[name][carried] for name in ("position", "velocity", "acceleration")))
    bulge, centres, radii = motion.bulge(), series["obstacle_position"], series["obstacle_radius"]
    if _is_far(motion, bulge, clearance):
        return None
    least = least_clearance(motion, bulge, centres, radii)
    if least is None or least > 0:
        return None
    pairs = _pairs(motion, bulge, centres)
    robot, obstacle = divmod(int(shortest(pairs, np.tile(radii, clearance.shape[1]), each=True).argmin()), len(radii))
    return float(times[clearance[:, robot, obstacle].argmin()]), robot, obstacle


def _is_far(motion: Motion, bulge: Array, clearance: Array) -> bool:
    """Whether no robot can come to an obstacle between samples, by how long its steps are alone."""
    if not clearance.size:
        return True
    nearest = clearance.min(axis=2)
    way = length_of(np.diff(motion.position, axis=0))
    return bool((np.minimum(nearest[:-1], nearest[1:]) - way - bulge > 0).all())


def _pairs(robots: Motion, bulge: Array, centres: Array) -> Vectors:
    """From every obstacle to every robot; the obstacles of the first robot come first."""

    def apart(position: Array) -> Array:
        vectors: Array = position[..., :, None, :] - centres
        return vectors.reshape(*position.shape[:-2], -1, 2)

    return Vectors.of_positions(robots, np.repeat(bulge, len(centres), axis=1), apart)
