"""The kinds of values in a scenario: numbers with bounds, points, graphs, matrices, and one-or-many of them."""

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
"""A coordinate (m). Farther out, rounding would eat the millimetres between robots."""

Length = Annotated[float, Field(gt=0, le=1e6)]
"""A length (m), bounded as coordinates are."""

Point = Annotated[tuple[Coordinate, Coordinate], Field(strict=False)]
"""Two coordinates in the world frame (m)."""

Velocity = Annotated[tuple[Coordinate, Coordinate], Field(strict=False)]
"""A velocity in the world frame (m/s), bounded as coordinates are."""

Gap = Annotated[float, Field(ge=1e-3, le=1e6)]
"""A distance to keep (m). A planner takes steps in proportion to it, so it is no shorter than a millimetre."""

Period = Annotated[float, Field(ge=1e-4, le=1e3)]
"""A sampling period (s); in shorter ones a run would do nothing else than sample."""

Probability = Annotated[float, Field(ge=0, le=1)]
NonNegative = Annotated[float, Field(ge=0)]
Positive = Annotated[float, Field(gt=0)]


def _named_or_edges(value: Any) -> str:
    return "edges" if isinstance(value, list | tuple) else "named"


def _all_or_listed(value: Any) -> str:
    return "listed" if isinstance(value, list | tuple) else "all"


def _cost_kind(value: Any) -> str:
    if not isinstance(value, list | tuple):
        return "scalar"
    return "matrix" if value and isinstance(value[0], list | tuple) else "diagonal"


TopologyName = Literal["complete", "cycle", "path", "star"]

Edge = Annotated[tuple[int, int], Field(strict=False)]
"""Two robots, numbered from 1."""

Graph = Annotated[
    Annotated[TopologyName, Tag("named")] | Annotated[tuple[Edge, ...], Field(strict=False), Tag("edges")],
    Discriminator(_named_or_edges),
]

Known = Annotated[
    Annotated[Literal["all"], Tag("all")] | Annotated[tuple[int, ...], Field(strict=False), Tag("listed")],
    Discriminator(_all_or_listed),
]
"""All obstacles, or some of them, numbered from 1."""

Row = Annotated[tuple[float, ...], Field(strict=False)]
CostMatrix = Annotated[
    Annotated[float, Tag("scalar")]
    | Annotated[Row, Tag("diagonal")]
    | Annotated[tuple[Row, ...], Field(strict=False), Tag("matrix")],
    Discriminator(_cost_kind),
]
"""A multiple of the identity, a diagonal, or the whole matrix."""


class Section(BaseModel):
    """A mapping of the scenario: strict, frozen, finite."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, allow_inf_nan=False)
