"""What a user may write in a sweep file: a base scenario, what to set in it, and the axes along which it varies.

As strict as scenarios are: an unknown key or a number in quotes is an error. What concerns several fields at once is in
:mod:`drake_formation.sweep.axes`.
"""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from drake_formation.config.json_schema import schema_of
from drake_formation.config.values import Positive, Section
from drake_formation.simulation.result import VARIABLES, VECTOR

Name = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$", max_length=100)]
"""A name that is also one in NetCDF."""

FieldPath = Annotated[str, Field(pattern=r"^[^.]+(\.[^.]+)*$", max_length=200)]
"""Dotted path of a scenario's field, such as ``springs.stiffness`` or ``robots.mass.0``."""

ITS_UNIT: dict[str, Any] = {"unit": "as the field's"}
"""Of what a sweep varies."""

Interval = Annotated[tuple[float, float], Field(strict=False)]
Steps = Annotated[tuple[float, float, Annotated[int, Field(ge=1)]], Field(strict=False)]
Values = Annotated[tuple[Any, ...], Field(strict=False, min_length=1)]
Labels = Annotated[tuple[str, ...], Field(strict=False)]

SERIES = tuple(name for name, (dimensions, _, _) in VARIABLES.items() if dimensions == VECTOR)
"""Variables of a run that a sweep may sample, each over robots and axes."""


def _path_kind(value: Any) -> str:
    return "paths" if isinstance(value, list | tuple) else "path"


def _scenario_kind(value: Any) -> str:
    return "mapping" if isinstance(value, dict) else "named"


Base = Annotated[
    Annotated[str, Tag("named")] | Annotated[dict[str, Any], Tag("mapping")], Discriminator(_scenario_kind)
]
"""A base scenario: by name, or as it stands in a file."""


def _axis_kind(value: Any) -> Any:
    return value.get("kind", "grid") if isinstance(value, dict) else getattr(value, "kind", None)


class GridAxis(Section):
    """One field, or several that take the same value, over given values; grid axes multiply."""

    kind: Literal["grid"] = Field(default="grid", description="kind of axis")
    name: Name | None = Field(default=None, description="name of the dimension; the field's own if not given")
    path: Annotated[
        Annotated[FieldPath, Tag("path")]
        | Annotated[tuple[FieldPath, ...], Field(strict=False, min_length=1), Tag("paths")],
        Discriminator(_path_kind),
    ] = Field(description="dotted path of a field, or a list of paths that take the same value")
    values: Values | None = Field(default=None, description="the values: numbers, names, lists, mappings")
    linspace: Steps | None = Field(
        default=None, description="[first, last, count], evenly spaced", json_schema_extra=ITS_UNIT
    )
    logspace: Steps | None = Field(
        default=None, description="[first, last, count], evenly spaced in the logarithm", json_schema_extra=ITS_UNIT
    )
    labels: Labels | None = Field(default=None, description="what to call each value; the value itself if not given")


class ZipAxis(Section):
    """Several fields that move together."""

    kind: Literal["zip"] = Field(description="kind of axis")
    name: Name = Field(default="case", description="name of the dimension")
    values: dict[FieldPath, Values] = Field(
        min_length=1, description="for each path its values, as many for one as for another"
    )
    labels: Labels | None = Field(default=None, description="what to call each case; its number if not given")


class ListPoint(Section):
    """One point of a list."""

    label: str = Field(min_length=1, description="what to call it")
    set: dict[FieldPath, Any] = Field(description="values by dotted path")


class ListAxis(Section):
    """Explicit points, each with a label."""

    kind: Literal["list"] = Field(description="kind of axis")
    name: Name = Field(default="point", description="name of the dimension")
    points: Annotated[tuple[ListPoint, ...], Field(strict=False, min_length=1)] = Field(description="the points")


class Distribution(Section):
    """One of four distributions."""

    uniform: Interval | None = Field(default=None, description="[low, high]", json_schema_extra=ITS_UNIT)
    loguniform: Interval | None = Field(
        default=None, description="[low, high], uniform in the logarithm", json_schema_extra=ITS_UNIT
    )
    normal: Interval | None = Field(default=None, description="[mean, standard deviation]", json_schema_extra=ITS_UNIT)
    integers: Annotated[tuple[int, int], Field(strict=False)] | None = Field(
        default=None, description="[low, high], whole numbers, both ends included"
    )


class RandomAxis(Section):
    """Random draws of one or several fields.

    Every field has a random stream of its own, made from the seed and its path: neither a larger count nor another
    field changes what was drawn before.
    """

    kind: Literal["random"] = Field(description="kind of axis")
    name: Name = Field(default="sample", description="name of the dimension")
    seed: int = Field(ge=0, description="seed of NumPy's default generator")
    count: int = Field(ge=1, description="how many samples")
    draw: dict[FieldPath, Distribution] = Field(min_length=1, description="for each path its distribution")


AxisModel = Annotated[
    Annotated[GridAxis, Tag("grid")]
    | Annotated[ZipAxis, Tag("zip")]
    | Annotated[ListAxis, Tag("list")]
    | Annotated[RandomAxis, Tag("random")],
    Discriminator(_axis_kind),
]


class Trajectories(Section):
    """What to keep of each run beside its metrics."""

    variables: Annotated[tuple[Literal[SERIES], ...], Field(strict=False, min_length=1)] = Field(  # type: ignore[valid-type]
        description="variables of the run's result"
    )
    every: Positive = Field(default=1.0, description="sampling interval (s), from the beginning of the run")


class SweepFile(Section):
    """Many runs: a base scenario and the axes along which it varies."""

    name: Name = Field(description="short name: letters, digits, and _ . - after the first")
    description: str = Field(default="", description="what it shows")
    scenario: Base = Field(
        description="the base: a file (relative to this one), the name of a shipped scenario, or a scenario"
    )
    set: dict[FieldPath, Any] = Field(default={}, description="values to replace in the base, by dotted path")
    axes: Annotated[tuple[AxisModel, ...], Field(strict=False, min_length=1)] = Field(
        description="what varies: axes of kind grid, zip, list or random, which multiply"
    )
    trajectories: Trajectories | None = Field(default=None, description="time series to keep; none if not given")


def json_schema() -> dict[str, Any]:
    """JSON Schema of sweep files; see :mod:`drake_formation.config.json_schema`."""
    return schema_of(SweepFile, "drake_formation sweep")


SECTIONS: dict[str | int, type[Section]] = {
    "grid": GridAxis,
    "zip": ZipAxis,
    "list": ListAxis,
    "points": ListPoint,
    "random": RandomAxis,
    "draw": Distribution,
    "trajectories": Trajectories,
}
"""Sections by the last name in pydantic's location that leads to them; all else is in :class:`SweepFile`."""
