"""Arguments and options that several commands have."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from drake_formation.cli.completion import names_of, override

Source = Annotated[
    str,
    typer.Argument(
        metavar="SCENARIO", help="A scenario file, or the name of a shipped one.", autocompletion=names_of("scenario")
    ),
]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="PATH=VALUE", help="Replace a field, e.g. springs.stiffness=3e4.", autocompletion=override
    ),
]


def path(text: str) -> Path:
    """A path as given; an empty one is a slip (a variable without a value, say) and not the current folder.

    Raises:
        BadParameter: it is empty.
    """
    if not text:
        raise typer.BadParameter("an empty name")
    return Path(text)


class EngineName(StrEnum):
    """What carries a run out."""

    AUTO = "auto"
    BLOCKS = "blocks"
    COMPILED = "compiled"
    EXPONENTIAL = "exponential"


class FormatName(StrEnum):
    """What figures are written as."""

    PNG = "png"
    PDF = "pdf"
    SVG = "svg"


Format = Annotated[FormatName, typer.Option("--format", help="Of the figures.")]

ENGINES_HELP = "The block diagram itself, or code compiled from it, integrated by steps or exponentially"
