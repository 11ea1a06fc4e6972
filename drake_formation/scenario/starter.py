"""A scenario to start from: every field of the schema with its meaning, unit and default, most commented out."""

import re
from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic.fields import FieldInfo

from drake_formation.config.errors import shown
from drake_formation.config.values import Section
from drake_formation.scenario.fields import CHOOSERS, names, phrase
from drake_formation.scenario.source import Document
from drake_formation.scenario.validate import validate
from drake_formation.shipped import schema_line, shipped

WIDTH = 116
"""Of a line of explanation."""

EXAMPLE: dict[str, Any] = {
    "description": "Two robots carry an object past an obstacle.",
    "formation": {"shape": "line", "robots": 2, "side": 1.0},
    "robots": {"start": {"centre": [0.0, 0.0]}},
    "consensus": {"delta": 10.0},
    "avoidance": {"obstacles": [{"position": [3.0, 1.2], "radius": 0.1}]},
    "transport": {"goal": [6.0, 0.0], "duration": 30.0},
}
"""What the starter says itself; all else it leaves at its default."""

HEAD = """\
# A scenario to start from. Lines that begin with ## explain; those with a single # are fields at their defaults: take
# the mark away, and change the value. drake-formation validate says what the file reads as, drake-formation show draws
# it, drake-formation run runs it, and drake-formation list parts names the kinds that parts may be of.
"""


def starter(name: str) -> str:
    """The text of a scenario file to start from.

    Args:
        name: of the scenario.

    Raises:
        ScenarioError: it cannot be one.
    """
    written = {"name": name, **EXAMPLE}
    scenario = validate(Document("the starter", written))
    return "\n".join([schema_line("scenario") + HEAD.rstrip(), *_section(scenario, written, "", []), ""])


def renamed(shipped_name: str, name: str) -> str:
    """The text of a shipped scenario under another name.

    Args:
        shipped_name: of the scenario that ships.
        name: the other one.

    Raises:
        ScenarioError: it cannot be a scenario's name.
    """
    validate(Document("the starter", {"name": name, **EXAMPLE}))
    text = shipped("scenario")[shipped_name].read_text(encoding="utf-8")
    body = re.sub(r"\A# yaml-language-server:.*\n", "", text)
    return schema_line("scenario") + re.sub(r"(?m)^name:.*$", f"name: {name}", body, count=1)


def _section(section: Section, written: Mapping[str, Any], margin: str, choices: list[str]) -> Iterator[str]:
    """A section's fields.

    Args:
        section: as it is read.
        written: what of it is written.
        margin: before every line.
        choices: what its chooser, if it has one, chooses from.
    """
    fields = type(section).model_fields
    chooser = next((key for key in CHOOSERS if key in fields), None) if choices else None
    # A section with nothing in it would be none, so that its chooser, or its first field, is there.
    live = {*written, chooser or next(iter(fields))}
    for key, info in fields.items():
        value, annotation = getattr(section, key), _annotation(info)
        if not margin:
            yield ""
        if isinstance(value, Section):
            yield from _explained(info.description or "", margin)
            yield f"{margin}{key}:"
            yield from _section(value, written.get(key, {}), margin + "  ", names(annotation))
            continue
        yield from _explained(_meaning(info, choices if key == chooser else names(annotation)), margin)
        mark = "" if key in live else "# "
        yield f"{margin}{mark}{key}: {shown(written.get(key, value))}"


def _annotation(info: FieldInfo) -> Any:
    return Annotated[info.annotation, *info.metadata] if info.metadata else info.annotation


def _meaning(info: FieldInfo, choices: list[str]) -> str:
    """What a field means, what it may choose from, and what a list that is empty may hold."""
    description = info.description or ""
    if choices:
        return f"{description}; one of {', '.join(choices)}"
    return f"{description}; {phrase(_annotation(info))}" if info.default == () else description


def _explained(text: str, margin: str) -> Iterator[str]:
    line = f"{margin}##"
    for word in text.split():
        if len(line) + 1 + len(word) > WIDTH:
            yield line
            line = f"{margin}##"
        line += f" {word}"
    yield line
