"""How near robots come to obstacles while they carry the object."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.formation.obstacles import Obstacles
from drake_formation.scenario import resolve
from drake_formation.simulation.extremes import Vectors, shortest
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.series import Series
from drake_formation.vectors import length_of

Array = NDArray[np.float64]
Indices = NDArray[np.intp]


def least_clearance(robots: Motion, bulge: Array, obstacles: Obstacles, footprints: Array) -> float | None:
    """Least distance of any robot to any obstacle at any time (m), negative inside; None without obstacles.

    Inside a polygon, whose depth it takes from the samples alone, no robot is without the run being ended.

    Args:
        robots: their motion.
        bulge: of that motion (m).
        obstacles: the obstacles.
        footprints: radius of each robot (m), shape (N,).
    """
    if not len(obstacles):
        return None
    pairs, radii, _ = _pairs(robots, bulge, obstacles, footprints)
    least = float(shortest(pairs, radii)[0])
    if all(vertices < 3 for vertices, _ in obstacles.layout):
        return least
    sampled = obstacles.clearance(robots.position, robots.times[:, None]) - footprints[:, None]
    return min(least, float(sampled.min()))


def contact(series: Series) -> tuple[float, int, int] | None:
    """Where a robot, without its footprint, is inside an obstacle during transport.

    Returns:
        The time of the first sample inside one, or of the one nearest to it where only what lies between samples is
        (s); the robot and the obstacle, from 0. None where all keep clear.
    """
    formation = resolve(series.scenario)
    carried = series["phase"] == 1
    times, clearance = series["time"][carried], series["clearance"][carried] + formation.footprints[:, None]
    inside = np.argwhere(clearance <= 0)
    if len(inside):
        sample, robot, obstacle = inside[0].tolist()
        return float(times[sample]), robot, obstacle
    motion = Motion(times, *(series[name][carried] for name in ("position", "velocity", "acceleration")))
    bulge = motion.bulge()
    if _is_far(motion, bulge, clearance, formation):
        return None
    pairs, radii, owners = _pairs(motion, bulge, formation.obstacles, np.zeros(formation.robots))
    nearest = shortest(pairs, radii, each=True)
    if not len(nearest) or nearest.min() > 0:
        return None
    robot, edge = divmod(int(nearest.argmin()), len(owners))
    obstacle = int(owners[edge])
    return float(times[clearance[:, robot, obstacle].argmin()]), robot, obstacle


def _is_far(motion: Motion, bulge: Array, clearance: Array, formation: Formation) -> bool:
    """Whether no robot can come to an obstacle between samples, by how long its steps are alone."""
    if not clearance.size:
        return True
    nearest = clearance.min(axis=2)
    way = length_of(np.diff(motion.position, axis=0))
    fastest = max(obstacle.top_speed for obstacle in formation.obstacles)
    if fastest:
        way = way + fastest * np.diff(motion.times)[:, None]
    return bool((np.minimum(nearest[:-1], nearest[1:]) - way - bulge > 0).all())


def _pairs(robots: Motion, bulge: Array, obstacles: Obstacles, footprints: Array) -> tuple[Vectors, Array, Indices]:
    """From every edge of the obstacles to every robot, those of the first robot first.

    Returns:
        The vectors; the radii of obstacle and robot together (m), one a vector; and of each edge the obstacle, from 0.
    """
    owners = obstacles.edge_owners
    begins, extents = obstacles.edges
    radii = (obstacles.radii[owners] + footprints[:, None]).ravel()
    moving = bool(len(obstacles.turns))
    if moving:  # between these samples obstacles move in straight lines
        robots = robots.with_samples_at(obstacles.turns)
        bulge = robots.bulge()

    def apart(times: Array, position: Array, _velocity: Array) -> Array:
        places = begins if not moving else begins + obstacles.displacements(times)[..., None, owners, :]
        vectors: Array = position[..., :, None, :] - places
        return vectors.reshape(*position.shape[:-2], -1, 2)

    samples = apart(robots.times, robots.position, robots.velocity)
    bulges = np.repeat(bulge, len(owners), axis=1)
    tiled = np.tile(extents, (len(footprints), 1)) if extents.any() else None
    return Vectors(robots, apart, samples, bulges, tiled), radii, owners
