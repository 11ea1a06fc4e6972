"""Schemas by which Foxglove knows its messages: every field of each, and nothing else.

What they mean is in Foxglove's documentation of them, https://docs.foxglove.dev/docs/sdk/schemas.
"""

from typing import Any

Schema = dict[str, Any]

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
