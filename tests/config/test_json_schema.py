"""What a schema says of every field, to editors and programs."""

import jsonschema
import pytest

from drake_formation import scenario
from drake_formation.compare import schema as compare
from drake_formation.config.json_schema import number_types, schema_of
from drake_formation.config.values import Section
from drake_formation.scenario.source import read
from drake_formation.shipped import shipped
from drake_formation.sweep import schema as sweep

SCHEMAS = {
    "scenario": scenario.json_schema,
    "sweep": sweep.json_schema,
    "comparison": compare.json_schema,
}


def fields(schema):
    for name, section in {schema["title"]: schema, **schema["$defs"]}.items():
        for key, field in section["properties"].items():
            yield f"{name}.{key}", field


@pytest.mark.parametrize("kind", SCHEMAS)
def test_every_field_has_title_and_description_and_every_number_its_unit(kind):
    schema = SCHEMAS[kind]()
    lacking = [
        f"{path}: {key}"
        for path, field in fields(schema)
        for key in ("title", "description", *(["unit"] if set(number_types(field)) else []))
        if not field.get(key)
    ]
    assert not lacking


def test_a_unit_is_where_numbers_are_and_says_what_the_description_says():
    found = dict(fields(scenario.json_schema()))
    assert found["HookeanSpring.stiffness"]["unit"] == "N/m"
    assert found["HookeanSpring.stiffness"]["title"] == "stiffness k_ij"
    assert found["Line.robots"]["unit"] == "1"
    assert "unit" not in found["HookeanSpring.law"]


def test_a_number_without_unit_is_noticed():
    class Careless(Section):
        size: float

    assert "unit" not in schema_of(Careless, "careless")["properties"]["size"]


@pytest.mark.parametrize("kind", SCHEMAS)
def test_the_schemas_accept_what_ships(kind):
    schema = SCHEMAS[kind]()
    jsonschema.Draft202012Validator.check_schema(schema)
    for file in shipped(kind).values():
        jsonschema.validate(read(file).data, schema)
