"""Where the robots have been: ribbons on the ground, in pieces that appear as the robots get there."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from pydrake.geometry import Meshcat, Rgba

from drake_formation.viz.playback import Playback
from drake_formation.viz.view.solids import Colour

Array = NDArray[np.float64]

PIECES, STEPS = 100, 12
"""Into how many pieces of equal duration a trail is cut, and each of them into how many straight ones."""

LOWEST, STEP_UP = 0.015, 0.0015
"""Height of the first ribbon, and of each over the one before, so that of ribbons that cross one is on top (m)."""

WIDTH = 0.07
"""Of a ribbon (m)."""


class Trails:
    """The ribbons, drawn at once; which of them are to be seen is recorded by :meth:`record`.

    Args:
        meshcat: where.
        root: path of all trails.
        playback: tells where the robots are.
        colours: of the robots, by number from 1.
    """

    def __init__(self, meshcat: Meshcat, root: str, playback: Playback, colours: Mapping[int, Colour]) -> None:
        self._meshcat, self._root = meshcat, root
        times = np.linspace(playback.begin, playback.end, PIECES * STEPS + 1)
        places = playback.positions(times)
        self._ends = (times[STEPS::STEPS] - playback.begin).tolist()
        for piece in range(PIECES):
            way = places[piece * STEPS : (piece + 1) * STEPS + 1]
            for i, (robot, colour) in enumerate(colours.items()):
                path = f"{self._path(piece)}/robot_{robot}"
                meshcat.SetTriangleMesh(path, *ribbon(way[:, i], LOWEST + i * STEP_UP), Rgba(*colour))

    def record(self) -> None:
        """Hide every piece at first, and show it from when its end is reached."""
        for piece, end in enumerate(self._ends):
            self._meshcat.SetProperty(self._path(piece), "visible", False, 0.0)
            self._meshcat.SetProperty(self._path(piece), "visible", True, end)

    def _path(self, piece: int) -> str:
        return f"{self._root}/{piece}"


def ribbon(places: Array, height: float) -> tuple[Array, NDArray[np.int32]]:
    """A ribbon along a way.

    Args:
        places: (m), shape (m, 2).
        height: above the ground (m).

    Returns:
        Vertices (m), shape (3, 2 m), on the left and the right of each place by turns; and triangles between them, of
        shape (3, 2 (m − 1)).
    """
    along = np.gradient(places, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    aside = 0.5 * WIDTH * np.stack([-along[:, 1], along[:, 0]], axis=-1)
    sides = np.stack([places + aside, places - aside], axis=1).reshape(-1, 2)
    first = 2 * np.arange(len(places) - 1)
    faces = np.concatenate([[first, first + 1, first + 2], [first + 1, first + 3, first + 2]], axis=1)
    return np.column_stack([sides, np.full(len(sides), height)]).T, faces.astype(np.int32)
