"""The messages are Foxglove's: their fields are those of the schemas that Foxglove publishes."""

import pytest
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.descriptor import FieldDescriptor as Field

from drake_formation.exporting import foxglove_schemas as ours

TIMES = {"google.protobuf.Timestamp": "time", "google.protobuf.Duration": "duration"}
PLAIN = {
    Field.CPPTYPE_DOUBLE: "number",
    Field.CPPTYPE_UINT32: "integer",
    Field.CPPTYPE_ENUM: "integer",
    Field.CPPTYPE_BOOL: "boolean",
    Field.CPPTYPE_STRING: "string",
}


def published(message):
    """What a message is made of, as ``own`` says it."""
    return {field.name: [of(field)] if field.is_repeated else of(field) for field in message.fields}


def of(field):
    if field.cpp_type != Field.CPPTYPE_MESSAGE:
        return PLAIN[field.cpp_type]
    return TIMES.get(field.message_type.full_name) or (field.message_type.full_name, published(field.message_type))


def own(schema):
    """What a message of this package's is made of."""
    if schema["type"] == "array":
        return [own(schema["items"])]
    if schema["type"] != "object":
        return schema["type"]
    if schema["title"] in TIMES.values():
        return schema["title"]
    assert schema["required"] == list(schema["properties"])
    return schema["title"], {name: own(field) for name, field in schema["properties"].items()}


@pytest.mark.parametrize(
    ("schema", "theirs"), [(ours.SCENE_UPDATE, SceneUpdate), (ours.FRAME_TRANSFORMS, FrameTransforms)]
)
def test_schemas_have_the_fields_that_foxglove_publishes(schema, theirs):
    assert own(schema) == (theirs.DESCRIPTOR.full_name, published(theirs.DESCRIPTOR))
