"""What a user may write of an obstacle: its shape, whether planners know it, and how it moves."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from drake_formation.config.values import NonNegative, Point, Section, Velocity

MOST_CORNERS = 24
"""A polygon's edges are looked at one by one, at every step."""


class Waypoint(Section):
    """Where an obstacle is at some time."""

    time: NonNegative = Field(description="when (s)")
    position: Point = Field(description="where its centre, first end or first corner is then (m)")


Known = Annotated[bool, Field(description="whether planners know it; robots sense it in any case")]
Moving = Annotated[
    Velocity | None, Field(description="velocity (m/s) with which it moves on from the time start; this or waypoints")
]
Waypoints = Annotated[
    tuple[Waypoint, ...],
    Field(
        strict=False,
        description="where it is when: it moves in straight lines from the time start on, and rests after the last",
    ),
]
Start = Annotated[NonNegative, Field(description="time at which it begins to move (s), if it does")]
KIND = "shape of the obstacle; a circle need not say so"
Radius = Annotated[NonNegative, Field(le=1e6)]


class Circle(Section):
    """A round obstacle; at radius 0 a point, as in the paper."""

    position: Point = Field(description="centre (m)")
    radius: Radius = Field(default=0.0, description="radius (m)")
    kind: Literal["circle"] = Field(default="circle", description=KIND)
    known: Known = True
    velocity: Moving = None
    waypoints: Waypoints = ()
    start: Start = 0.0


class Segment(Section):
    """A wall as wide as twice its radius, with round ends."""

    kind: Literal["segment"] = Field(description=KIND)
    ends: Annotated[tuple[Point, Point], Field(strict=False)] = Field(description="its two ends (m)")
    radius: Radius = Field(default=0.0, description="half its width (m)")
    known: Known = True
    velocity: Moving = None
    waypoints: Waypoints = ()
    start: Start = 0.0


class PolygonObstacle(Section):
    """A polygon with its inside, whose edges do not cross.

    In a notch the direction of an obstacle's field jumps where two edges are equally near.
    """

    kind: Literal["polygon"] = Field(description=KIND)
    vertices: Annotated[tuple[Point, ...], Field(strict=False, min_length=3, max_length=MOST_CORNERS)] = Field(
        description=f"its corners in their order, either way round, at most {MOST_CORNERS} (m)"
    )
    radius: Radius = Field(default=0.0, description="by how much it is grown all round (m)")
    known: Known = True
    velocity: Moving = None
    waypoints: Waypoints = ()
    start: Start = 0.0


def _kind(value: Any) -> Any:
    """The kind of an obstacle as written; a circle need not say so."""
    return value.get("kind", "circle") if isinstance(value, dict) else getattr(value, "kind", "circle")


Obstacle = Annotated[
    Annotated[Circle, Tag("circle")] | Annotated[Segment, Tag("segment")] | Annotated[PolygonObstacle, Tag("polygon")],
    Discriminator(_kind),
]
"""An obstacle of any kind."""
