"""What the shell offers while a command is typed, without importing Drake: shipped files, and what schemas name."""

import json
from collections.abc import Callable, Iterator
from typing import Any

from drake_formation.shipped import schema_file, shipped


def names_of(kind: str) -> Callable[[str], list[str]]:
    """What completes the name of a shipped file of some kind; the shell itself completes other files."""

    def complete(incomplete: str) -> list[str]:
        return [name for name in shipped(kind) if name.startswith(incomplete)]

    return complete


def override(incomplete: str) -> list[str]:
    """What completes ``PATH=VALUE``: paths section by section, and names where a field is one of several.

    It goes by the schema that the package brings, which knows the package's own parts. To bash a word ends at ``=``, so
    that there the shell asks for paths alone.
    """
    schema = json.loads(schema_file("scenario").read_text(encoding="utf-8"))
    path, equals, _ = incomplete.partition("=")
    if equals:
        fields = list(_fields(schema, path.split(".")))
        values = dict.fromkeys(value for field in fields for value in _values(schema, field))
        return [text for value in values if (text := f"{path}={value}").startswith(incomplete)]
    *around, _ = path.split(".")
    sections = list(_fields(schema, around)) if around else [schema]
    offered: dict[str, None] = {}
    for key, field in (item for section in sections for item in _properties(schema, section)):
        leads_on = any(True for _ in _properties(schema, field))
        offered[".".join([*around, key]) + ("." if leads_on else "=")] = None
    return [text for text in offered if text.startswith(incomplete)]


def listed(what: str, incomplete: str) -> list[str]:
    """What completes a name to list."""
    if what == "metrics":
        from drake_formation.measuring.registry import known

        names = list(known())
    elif what == "parts":
        schema = json.loads(schema_file("scenario").read_text(encoding="utf-8"))
        sections = schema["$defs"].values()
        fields = (
            section["properties"][key]
            for section in sections
            for key in ("kind", "law")
            if key in section["properties"]
        )
        names = sorted({field["const"] for field in fields if "const" in field})
    else:
        names = list(shipped(what.removesuffix("s")))
    return [name for name in names if name.startswith(incomplete)]


def _branches(schema: dict[str, Any], field: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """A field, or all that it may be."""
    if "$ref" in field:
        field = schema["$defs"][field["$ref"].rpartition("/")[2]]
    choices = field.get("oneOf", []) + field.get("anyOf", [])
    for choice in choices:
        yield from _branches(schema, choice)
    if not choices:
        yield field


def _properties(schema: dict[str, Any], field: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    for branch in _branches(schema, field):
        yield from branch.get("properties", {}).items()


def _fields(schema: dict[str, Any], path: list[str]) -> Iterator[dict[str, Any]]:
    """All that may stand at a path."""
    fields = [schema]
    for key in path:
        fields = [inner for field in fields for name, inner in _properties(schema, field) if name == key]
    yield from fields


def _values(schema: dict[str, Any], field: dict[str, Any]) -> Iterator[str]:
    """Names that a field may have."""
    for branch in _branches(schema, field):
        names = branch.get("enum", [branch["const"]] if "const" in branch else [])
        yield from ["true", "false"] if branch.get("type") == "boolean" else names
