"""A minimum distance to round obstacles, linearized: a half-plane for each obstacle, robot and sample of a path.

Outside a disc is no convex set, but the half-plane that touches the disc on the robot's side is one, and lies outside.
A path is believed as far as it keeps its distance; from there on the half-plane of its last good point counts, so that
a path through an obstacle is turned back and not taken for one behind it. Linearizing about the predicted path is
successive convexification: J. Schulman et al., "Motion planning with sequential convex optimization and convex
collision checking", International Journal of Robotics Research 33(9), 2014, Sec. 4.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

GRAZING = 1e-3
"""How much nearer than asked for a path may come and still be believed (m): those that slide along an obstacle do."""


def normals(path: Array, obstacles: Array, distance: Array) -> Array:
    """Unit normals of the half-planes, away from the obstacles.

    Args:
        path: positions of the robots now and at the samples 1 … H (m), shape (H + 1, N, 2).
        obstacles: centre and radius of each (m), shape (M, 3).
        distance: that every robot is to keep (m), shape (N,).

    Returns:
        A normal for the samples 1 … H, shape (H, N, M, 2).
    """
    away = path[:, :, None] - obstacles[:, :2]
    apart = np.linalg.norm(away, axis=-1)
    clear = _least_apart(away) >= obstacles[:, 2] + distance[:, None] - GRAZING
    believed = np.logical_and.accumulate(clear, axis=0).sum(axis=0)  # sample of the last good point, 0 for now
    samples = np.minimum(np.arange(1, len(path))[:, None, None], believed)
    robots, seen = np.indices(believed.shape)
    directions: Array = away[samples, robots, seen] / np.maximum(apart[samples, robots, seen], 1e-12)[..., None]
    return directions


def _least_apart(away: Array) -> Array:
    """How near each step of a path comes to the origin (m), shape (H, …), for points of shape (H + 1, …, 2)."""
    begin, step = away[:-1], np.diff(away, axis=0)
    squared = np.maximum((step * step).sum(axis=-1), np.finfo(float).tiny)
    share = np.clip(-(begin * step).sum(axis=-1) / squared, 0.0, 1.0)
    nearest: Array = np.linalg.norm(begin + share[..., None] * step, axis=-1)
    return nearest
