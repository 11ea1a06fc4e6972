"""What stands still: the ground, the goal, and the camera."""

import numpy as np
from numpy.typing import NDArray
from pydrake.geometry import Cylinder, Meshcat, Rgba
from pydrake.math import RigidTransform

from drake_formation.viz.playback import Playback
from drake_formation.viz.view.solids import Solid

Array = NDArray[np.float64]

MARGIN = 1.0
"""How far the ground reaches beyond what moves (m)."""

MOST_LINES = 60
"""Lines on the ground along each axis; with more, they are further apart."""

LAMPS = ("SpotLight", "PointLightNegativeX", "PointLightPositiveX")
LIGHTS = dict.fromkeys(LAMPS, 0.0) | {"AmbientLight": 1.8, "FillLight": 1.4}
"""Of Meshcat's lights those that reach everything alike: lamps about the origin would leave the rest dark."""

SUN = [-5.0, 10.0, 6.0]
"""Whence the fill light comes, in Meshcat's own frame, where y is up."""

FIELD_OF_VIEW = 35.0
"""Of the camera, upwards (deg)."""


def goal(playback: Playback, robot: int) -> Solid:
    """Where a robot, from 0, is to come to rest."""
    x, y = playback.formation.goal + playback.formation.slots[robot]
    return Solid(Cylinder(0.14, 0.012), RigidTransform([x, y, 0.012]))


def bounds(playback: Playback, places: Array) -> tuple[Array, Array]:
    """Corners of the ground (m): of where the robots are on their way, of shape (m, N, 2), and of what stands there."""
    low, high = playback.seen(places)
    return np.floor(low - MARGIN), np.ceil(high + MARGIN)


def set_stage(meshcat: Meshcat, root: str, low: Array, high: Array) -> None:
    """Draw the ground, metre by metre or by ten where that is too fine, under a light sky.

    Args:
        meshcat: where.
        root: path of the ground.
        low: its left front corner (m).
        high: its right back corner (m).
    """
    for path in ("/Grid", "/Axes"):
        meshcat.SetProperty(path, "visible", False)
    for side in ("top_color", "bottom_color"):
        meshcat.SetProperty("/Background/<object>", side, [0.97, 0.97, 0.98])
    for light, intensity in LIGHTS.items():
        meshcat.SetProperty(f"/Lights/{light}/<object>", "intensity", intensity)
    meshcat.SetProperty("/Lights/FillLight/<object>", "position", SUN)
    unit = 10.0 ** max(0.0, np.ceil(np.log10((high - low).max() / MOST_LINES)))
    for step, grey in ((unit, 0.86), (5 * unit, 0.66)):
        starts, ends = _lines(low, high, step)
        meshcat.SetLineSegments(f"{root}/every {step:g} m", starts, ends, 1.0, Rgba(grey, grey, grey, 1.0))


def look_at(meshcat: Meshcat, low: Array, high: Array) -> None:
    """Look from the south and above, so far off that a window of twice its height shows all between two corners (m)."""
    (x, y), (width, depth) = 0.5 * (low + high), high - low
    camera = "/Cameras/default/rotated/<object>"
    meshcat.SetProperty(camera, "fov", FIELD_OF_VIEW)
    meshcat.SetProperty(camera, "far", 1e4)
    away = 0.5 * max(0.5 * width, depth) / np.tan(np.radians(FIELD_OF_VIEW) / 2)
    meshcat.SetCameraPose([x, y - 0.75 * away, 0.75 * away], [x, y, 0.0])


def _lines(low: Array, high: Array, step: float) -> tuple[Array, Array]:
    (left, bottom), (right, top) = low, high
    across = np.arange(np.ceil(left / step), np.floor(right / step) + 1) * step
    up = np.arange(np.ceil(bottom / step), np.floor(top / step) + 1) * step
    starts = [*((x, bottom, 0.0) for x in across), *((left, y, 0.0) for y in up)]
    ends = [*((x, top, 0.0) for x in across), *((right, y, 0.0) for y in up)]
    return np.array(starts).T.reshape(3, -1), np.array(ends).T.reshape(3, -1)
