"""``drake-formation schema``: the JSON Schema of a file."""

import json
from enum import StrEnum
from typing import Annotated, Any

import typer

from drake_formation.cli.app import command
from drake_formation.terminal import say


class FileKind(StrEnum):
    """Files that users write."""

    SCENARIO = "scenario"
    SWEEP = "sweep"
    COMPARISON = "comparison"


@command(answers=False)
def schema(kind: Annotated[FileKind, typer.Argument(help="What is in the file.")] = FileKind.SCENARIO) -> None:
    """Print the JSON Schema of a scenario, a sweep or a comparison, for editors; it knows all parts installed here."""
    say(json.dumps(_schema(kind), indent=2, ensure_ascii=False))


def _schema(kind: FileKind) -> dict[str, Any]:
    if kind is FileKind.SWEEP:
        from drake_formation.sweep.schema import json_schema
    elif kind is FileKind.COMPARISON:
        from drake_formation.compare.schema import json_schema
    else:
        from drake_formation.scenario import json_schema
    return json_schema()
