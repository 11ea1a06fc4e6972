"""Messages of Foxglove in which a result is told, as JSON, with every field of their schemas."""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.exporting.foxglove_schemas import PRIMITIVES
from drake_formation.exporting.shapes import Piece

Array = NDArray[np.float64]
Message = dict[str, Any]

LINE_STRIP, LINE_LIST = 0, 2
"""Lines from each point to the next, or between every two points."""


def timestamp(nanoseconds: int) -> Message:
    """A time as messages have it."""
    seconds, rest = divmod(nanoseconds, 10**9)
    return {"sec": seconds, "nsec": rest}


def transform(time: int, frame: str, x: float, y: float, heading: float) -> Message:
    """Where a frame is in the world at a time (ns): its place (m), and its heading about z (rad)."""
    turned = quaternion((np.cos(heading / 2), 0.0, 0.0, np.sin(heading / 2)))
    return {
        "timestamp": timestamp(time),
        "parent_frame_id": "world",
        "child_frame_id": frame,
        "translation": vector((x, y, 0.0)),
        "rotation": turned,
    }


def entity(name: str, frame: str, time: int, **primitives: list[Message]) -> Message:
    """What is seen in a frame from a time on (ns), until there is another of the same name."""
    return {
        "timestamp": timestamp(time),
        "frame_id": frame,
        "id": name,
        "lifetime": {"sec": 0, "nsec": 0},
        "frame_locked": True,
        "metadata": [],
        **{kind: primitives.get(kind, []) for kind in PRIMITIVES},
    }


def scene_update(entities: Iterable[Message]) -> Message:
    """What is seen from now on."""
    return {"deletions": [], "entities": list(entities)}


def lines(points: Array, thickness: float, colours: Array, how: int = LINE_LIST) -> Message:
    """Lines between points (m), shape (n, 3), in one colour, shape (4,), or that of every point, shape (n, 4)."""
    each = colours if colours.ndim == 2 else np.zeros((0, 4))
    return {
        "type": how,
        "pose": pose((0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
        "thickness": thickness,
        "scale_invariant": False,
        "points": [vector(point) for point in points.tolist()],
        "color": colour(colours.tolist() if colours.ndim == 1 else (0.0, 0.0, 0.0, 1.0)),
        "colors": [colour(values) for values in each.tolist()],
        "indices": [],
    }


def primitives(pieces: Iterable[Piece]) -> dict[str, list[Message]]:
    """Solid pieces as an entity has them."""
    found: dict[str, list[Message]] = {}
    for piece in pieces:
        own: Message = {"pose": pose(piece.place, piece.turned), "color": colour(piece.colour)}
        if piece.kind == "triangles":
            own |= {"points": [vector(point) for point in piece.corners.tolist()], "colors": [], "indices": []}
        else:
            own |= {"size": vector(piece.size)}
        if piece.kind == "cylinders":
            own |= {"bottom_scale": 1.0, "top_scale": 1.0}
        found.setdefault(piece.kind, []).append(own)
    return found


def pose(place: Iterable[float], turned: Iterable[float]) -> Message:
    """A place (m) and a turn, as a quaternion, its real part first."""
    return {"position": vector(place), "orientation": quaternion(turned)}


def vector(values: Iterable[float]) -> Message:
    """Three numbers."""
    return dict(zip("xyz", map(float, values), strict=True))


def quaternion(values: Iterable[float]) -> Message:
    """A turn, its real part first."""
    return dict(zip("wxyz", map(float, values), strict=True))


def colour(values: Iterable[float]) -> Message:
    """Red, green, blue and how opaque, from 0 to 1."""
    return dict(zip("rgba", map(float, values), strict=True))
