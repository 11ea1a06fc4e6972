"""From what pydantic finds wrong with a file of many runs to faults as scenarios have them."""

from collections.abc import Mapping
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from drake_formation.config.errors import MESSAGES, Fault, Path, nearest, shown
from drake_formation.config.values import Section
from drake_formation.scenario.source import Document

File = TypeVar("File", bound=Section)
Sections = Mapping[str | int, type[Section]]
"""Sections by the last name in pydantic's location that leads to them; all else is in the file's own."""


def parsed(document: Document, model: type[File], sections: Sections) -> File:
    """The model of a document.

    Args:
        document: a file.
        model: what it is to be.
        sections: what is in it.

    Raises:
        ScenarioError: with all faults of single fields.
    """
    try:
        return model.model_validate(document.data)
    except ValidationError as error:
        around: Sections = {"": model, **sections}
        details = error.errors(include_url=False)
        raise document.attributed(_fault(document.data, detail, around) for detail in details) from error


def _fault(data: Any, detail: ErrorDetails, sections: Sections) -> Fault:
    kind, value = detail["type"], detail["input"]
    section = _section(detail["loc"], sections)
    path = _path(data, detail["loc"], named=kind in ("missing", "extra_forbidden"))
    message = MESSAGES.get(kind, "not allowed")
    if kind == "extra_forbidden":
        keys = section.model_fields
        return Fault(path, message, allowed=", ".join(keys), suggestion=nearest(path[-1], keys))
    field = section.model_fields.get(str(path[-1])) if path else None
    description = (field and field.description) or ""
    if kind == "missing":
        return Fault(path, message, allowed=description)
    if kind == "union_tag_invalid":
        tags = detail["ctx"]["expected_tags"].replace("'", "")
        return Fault((*path, "kind"), message, shown(detail["ctx"]["tag"]), tags)
    allowed = " — ".join(filter(None, [_words(detail), description]))
    return Fault(path, message, shown(value), allowed)


def _words(detail: ErrorDetails) -> str:
    """What pydantic expects, without its opening."""
    return detail["msg"].removeprefix("Input should be ").removeprefix("Value should be ").replace("'", "")


def _section(loc: Path, sections: Sections) -> type[Section]:
    """The section around a location."""
    return sections[next((part for part in reversed(loc[:-1]) if part in sections), "")]


def _path(data: Any, loc: Path, named: bool) -> Path:
    """A location without the tags of unions, which a user did not write.

    Args:
        data: the document's.
        loc: pydantic's location.
        named: whether its last part is a key that stands, or should stand, in the document.
    """
    path: Path = ()
    for part in loc[:-1] if named else loc:
        if part == "[key]":
            break
        inside: Any = data
        if (isinstance(data, dict) and part in data) or (isinstance(data, list) and isinstance(part, int)):
            path, data = (*path, part), inside[part]
    return (*path, loc[-1]) if named else path
