"""The messages of Foxglove that a result is told in, as JSON, with the schemas by which Foxglove knows them.

What they mean is in Foxglove's documentation of its schemas, https://docs.foxglove.dev/docs/sdk/schemas. A schema here
names every field of a message and says nothing else, and every message has every field.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.exporting.shapes import Piece

Array = NDArray[np.float64]
Schema = dict[str, Any]
Message = dict[str, Any]

LINE_STRIP, LINE_LIST = 0, 2
"""Lines from each point to the next, or between every two points."""

NUMBER: Schema = {"type": "number"}
INTEGER: Schema = {"type": "integer"}
BOOLEAN: Schema = {"type": "boolean"}
STRING: Schema = {"type": "string"}


def record(title: str, **fields: Schema) -> Schema:
    """The schema of an object with these fields."""
    return {"title": title, "type": "object", "properties": fields, "required": list(fields)}


def several(items: Schema) -> Schema:
    """The schema of a list."""
    return {"type": "array", "items": items}


TIME = record("time", sec=INTEGER, nsec=INTEGER)
DURATION = record("duration", sec=INTEGER, nsec=INTEGER)
VECTOR = record("foxglove.Vector3", x=NUMBER, y=NUMBER, z=NUMBER)
POINT = record("foxglove.Point3", x=NUMBER, y=NUMBER, z=NUMBER)
QUATERNION = record("foxglove.Quaternion", x=NUMBER, y=NUMBER, z=NUMBER, w=NUMBER)
POSE = record("foxglove.Pose", position=VECTOR, orientation=QUATERNION)
COLOUR = record("foxglove.Color", r=NUMBER, g=NUMBER, b=NUMBER, a=NUMBER)

ARROW = record(
    "foxglove.ArrowPrimitive",
    pose=POSE,
    shaft_length=NUMBER,
    shaft_diameter=NUMBER,
    head_length=NUMBER,
    head_diameter=NUMBER,
    color=COLOUR,
)
CUBE = record("foxglove.CubePrimitive", pose=POSE, size=VECTOR, color=COLOUR)
SPHERE = record("foxglove.SpherePrimitive", pose=POSE, size=VECTOR, color=COLOUR)
CYLINDER = record(
    "foxglove.CylinderPrimitive", pose=POSE, size=VECTOR, bottom_scale=NUMBER, top_scale=NUMBER, color=COLOUR
)
LINE = record(
    "foxglove.LinePrimitive",
    type=INTEGER,
    pose=POSE,
    thickness=NUMBER,
    scale_invariant=BOOLEAN,
    points=several(POINT),
    color=COLOUR,
    colors=several(COLOUR),
    indices=several(INTEGER),
)
TRIANGLES = record(
    "foxglove.TriangleListPrimitive",
    pose=POSE,
    points=several(POINT),
    color=COLOUR,
    colors=several(COLOUR),
    indices=several(INTEGER),
)
TEXT = record(
    "foxglove.TextPrimitive",
    pose=POSE,
    billboard=BOOLEAN,
    font_size=NUMBER,
    scale_invariant=BOOLEAN,
    color=COLOUR,
    text=STRING,
)
MODEL = record(
    "foxglove.ModelPrimitive",
    pose=POSE,
    scale=VECTOR,
    color=COLOUR,
    override_color=BOOLEAN,
    url=STRING,
    media_type=STRING,
    data={"type": "string", "contentEncoding": "base64"},
)
PRIMITIVES = {
    "arrows": ARROW,
    "cubes": CUBE,
    "spheres": SPHERE,
    "cylinders": CYLINDER,
    "lines": LINE,
    "triangles": TRIANGLES,
    "texts": TEXT,
    "models": MODEL,
}
ENTITY = record(
    "foxglove.SceneEntity",
    timestamp=TIME,
    frame_id=STRING,
    id=STRING,
    lifetime=DURATION,
    frame_locked=BOOLEAN,
    metadata=several(record("foxglove.KeyValuePair", key=STRING, value=STRING)),
    **{name: several(primitive) for name, primitive in PRIMITIVES.items()},
)
DELETION = record("foxglove.SceneEntityDeletion", timestamp=TIME, type=INTEGER, id=STRING)
TRANSFORM = record(
    "foxglove.FrameTransform",
    timestamp=TIME,
    parent_frame_id=STRING,
    child_frame_id=STRING,
    translation=VECTOR,
    rotation=QUATERNION,
)

SCENE_UPDATE = record("foxglove.SceneUpdate", deletions=several(DELETION), entities=several(ENTITY))
FRAME_TRANSFORMS = record("foxglove.FrameTransforms", transforms=several(TRANSFORM))


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
