"""What a user may write in a comparison file: one scenario, and the laws, cases and seeds that it runs under."""

from typing import Annotated, Any

from pydantic import Field

from drake_formation.config.json_schema import schema_of
from drake_formation.config.values import Section
from drake_formation.sweep.schema import Base, FieldPath, Name

Label = Annotated[str, Field(min_length=1, max_length=60)]
"""What tables and figures call something."""


class Variant(Section):
    """A law or a case: a name, and what it replaces in the scenario."""

    name: Label = Field(description="what tables and figures call it")
    set: dict[FieldPath, Any] = Field(default={}, description="values and sections to replace, by dotted path")


class ComparisonFile(Section):
    """One scenario under several laws, with the same starts, seeds and obstacles."""

    name: Name = Field(description="short name: letters, digits, and _ . - after the first")
    description: str = Field(default="", description="what it shows")
    scenario: Base = Field(description="a file (relative to this one), the name of a shipped scenario, or a scenario")
    set: dict[FieldPath, Any] = Field(default={}, description="values to replace for all laws, by dotted path")
    laws: Annotated[tuple[Variant, ...], Field(strict=False, min_length=1)] = Field(
        description="what is compared: for each law its name and what it replaces, any field or part"
    )
    cases: Annotated[tuple[Variant, ...], Field(strict=False, min_length=1)] = Field(
        default=(Variant(name="all"),),
        description="where they are compared, such as rubber and steel; set after the law",
    )
    seeds: Annotated[tuple[Annotated[int, Field(ge=0)], ...], Field(strict=False)] = Field(
        default=(), description="for robots.start.random.seed, one run each; the scenario's own start if not given"
    )


def json_schema() -> dict[str, Any]:
    """JSON Schema of comparison files; see :mod:`drake_formation.config.json_schema`."""
    return schema_of(ComparisonFile, "drake_formation comparison")


SECTIONS: dict[str | int, type[Section]] = {"laws": Variant, "cases": Variant}
"""Sections of the file by the key that leads to them."""
