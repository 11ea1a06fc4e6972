"""What a scenario may say, as tables made of its JSON Schema."""

from collections.abc import Iterator
from typing import Any

from building.roles import in_markdown
from drake_formation.markdown import markdown_table
from drake_formation.parts.roles import ROLES
from drake_formation.scenario import json_schema

Schema = dict[str, Any]

HEADING = ("field", "value", "default", "meaning")
INTRODUCTION = """# The scenario

Every field that a scenario may have, from the schema that checks it (`drake-formation schema` prints it for editors).
A field marked *each* is one value for all, a list, or a mapping such as `{1: 50.0, default: 40.0}`. Which kind a
section is of is said by `kind` (by `law` for springs); what each kind is, and where it comes from, is in
[the parts](parts.md).
"""
BOUNDS = {"exclusiveMinimum": "> ", "minimum": "≥ ", "exclusiveMaximum": "< ", "maximum": "≤ "}


def scenario_page() -> str:
    """The page of all sections."""
    schema = json_schema()
    sections = schema["$defs"]
    parts = [INTRODUCTION, "## At the top", _table(schema)]
    for name in _in_order(sections):
        section = sections[name]
        parts += [f"### {_title(name, section)} {{ #{name} }}", _first_line(section), _table(section)]
    return "\n\n".join(part for part in parts if part) + "\n"


def _in_order(sections: Schema) -> Iterator[str]:
    """Sections as a scenario has them: those of a role together; mixtures only repeat what their kinds say."""
    names = [name for name in sections if not name.startswith("Mixed")]
    roles = [role.title().replace("_", "") for role in ROLES]
    yield from (name for name in names if not name.endswith(tuple(roles)))
    for role in roles:
        yield from (name for name in names if name.endswith(role))


def _title(name: str, section: Schema) -> str:
    for chooser in ("kind", "law", "shape"):
        value = section.get("properties", {}).get(chooser, {}).get("const")
        role = next((role for role in ROLES if name.endswith(role.title())), None)
        if value and role:
            return f"`{'.'.join(ROLES[role].section)}`, {chooser} `{value}`"
        if value:
            return f"{chooser} `{value}`"
    return name


def _first_line(section: Schema) -> str:
    return in_markdown(str(section.get("description", "")).split("\n\n")[0].replace("\n", " "))


def _table(section: Schema) -> str:
    required = section.get("required", ())
    rows = [
        (f"`{name}`", value_text(field), _default(name, field, required), str(field.get("description", "")))
        for name, field in section.get("properties", {}).items()
        if "const" not in field
    ]
    return markdown_table(HEADING, rows) if rows else ""


def _default(name: str, field: Schema, required: Any) -> str:
    if name in required:
        return "required"
    return "" if field.get("default") in (None, "", [], {}) else f"`{_yaml(field['default'])}`"


def _yaml(value: Any) -> str:
    """A value in YAML, on one line."""
    match value:
        case bool():
            return str(value).lower()
        case dict():
            return "{" + ", ".join(f"{key}: {_yaml(its)}" for key, its in value.items()) + "}"
        case list() | tuple():
            return "[" + ", ".join(map(_yaml, value)) + "]"
    return str(value)


def value_text(field: Schema) -> str:
    """What values a field takes, in words."""
    if "$ref" in field:
        name = field["$ref"].rpartition("/")[2]
        return f"[{name}](#{name})"
    if "const" in field:
        return f"`{field['const']}`"
    if "enum" in field:
        return ", ".join(f"`{value}`" for value in field["enum"])
    choices = field.get("oneOf", field.get("anyOf"))
    if choices:
        return _choice_text([choice for choice in choices if choice.get("type") != "null"])
    if field.get("type") == "array":
        return f"list of {value_text(field['items'])}" if field.get("items") else "list"
    return " ".join(filter(None, [_type_text(field), ", ".join(_bounds(field))]))


def _choice_text(choices: list[Schema]) -> str:
    first = choices[0]
    if any(choice.get("additionalProperties") == first or choice.get("items") == first for choice in choices[1:]):
        return f"{value_text(first)}, *each*"
    texts = [
        value_text(choice) for choice in choices if not choice.get("$ref", "").rpartition("/")[2].startswith("Mixed")
    ]
    return " or ".join(dict.fromkeys(texts))


def _type_text(field: Schema) -> str:
    kinds = {"string": "text", "boolean": "`true` or `false`", "integer": "whole number", "object": "mapping"}
    return kinds.get(field.get("type", ""), field.get("type", "anything"))


def _bounds(field: Schema) -> Iterator[str]:
    return (f"{sign}{field[key]:g}" for key, sign in BOUNDS.items() if key in field)
