"""JSON Schema of a file, for editors that complete and explain while one writes, and for programs that know no Python.

Every field has a title and a description, and every number the key ``unit``: ``N/m``, 1 for a plain number.
"""

from collections.abc import Iterator
from typing import Any

from drake_formation.config.labels import name_of, unit_of
from drake_formation.config.values import Section

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema_of(model: type[Section], title: str) -> dict[str, Any]:
    """The schema of a file.

    Args:
        model: what may stand in it.
        title: what it is called.
    """
    schema = {"$schema": DIALECT, **model.model_json_schema(), "title": title}
    for section in (schema, *schema.get("$defs", {}).values()):
        for key, field in section.get("properties", {}).items():
            measured = bool(unit_of(field.get("description", "")))
            field["title"] = name_of(key, field["description"] if measured else "")
            if unit := _unit(field):
                field["unit"] = unit
    return schema


def _unit(field: dict[str, Any]) -> str:
    """Of a field's numbers, as it says it; whole numbers need not say that they are plain."""
    numbers = set(number_types(field))
    said = str(field.get("unit") or unit_of(field.get("description", "")))
    return (said or ("1" if numbers == {"integer"} else "")) if numbers else ""


def number_types(field: dict[str, Any]) -> Iterator[str]:
    """``number`` or ``integer`` for every place of a field's value that may hold one, in lists and mappings too."""
    if field.get("type") in ("number", "integer"):
        yield field["type"]
    inner = [*field.get("oneOf", []), *field.get("anyOf", []), *field.get("prefixItems", [])]
    for part in (*inner, field.get("items"), field.get("additionalProperties")):
        if isinstance(part, dict):
            yield from number_types(part)
