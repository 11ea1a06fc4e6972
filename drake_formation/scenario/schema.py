"""What a user may write in a scenario, field by field, with units and sources.

The models are strict: an unknown key, a number in quotes or a NaN is an error, never a guess. What concerns
one field alone is declared here; what concerns several fields at once is in :mod:`drake_formation.scenario.checks`.
Sources: *published* is printed in the paper, *inferred* follows from what it prints, *chosen* is this project's.
"""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, SerializerFunctionWrapHandler, Tag, model_serializer

from drake_formation.config.each import each
from drake_formation.config.values import Edge, Graph, Length, NonNegative, Point, Positive, Section, TopologyName
from drake_formation.formation.formation import SPRINGS
from drake_formation.parts.registry import when_changed
from drake_formation.scenario.failures import Failure
from drake_formation.scenario.obstacles import Obstacle
from drake_formation.scenario.written import PartOf, rebuild_sections

MOST_ROBOTS = 1000
"""A complete graph among more robots has a million channels and more."""


def _start_kind(value: Any) -> str:
    if isinstance(value, RandomStart) or (isinstance(value, dict) and "random" in value):
        return "random"
    if isinstance(value, dict | FormationStart):
        return "formation"
    return "positions"


class Line(Section):
    """Robots in a row through the formation centre."""

    shape: Literal["line"] = Field(description="shape of the formation")
    robots: int = Field(ge=1, le=MOST_ROBOTS, description="number of robots N")
    side: Length = Field(description="distance between neighbours (m)")
    heading: float = Field(
        default=90.0, description="direction from the first robot to the last, from +x counter-clockwise (deg)"
    )


class Polygon(Section):
    """Robots on the corners of a regular polygon, counter-clockwise.

    By default the first robot is the left end of a horizontal top edge (as the paper numbers its square).
    """

    shape: Literal["polygon"] = Field(description="shape of the formation")
    robots: int = Field(ge=2, le=MOST_ROBOTS, description="number of robots N, one a corner")
    side: Length | None = Field(default=None, description="length of a side (m); give this or width")
    width: Length | None = Field(
        default=None, description="width across flats (m), for 4, 6, 8 … robots; give this or side"
    )
    heading: float | None = Field(
        default=None, description="direction from the centre to the first robot, from +x counter-clockwise (deg)"
    )


class Grid(Section):
    """Robots on a rectangular grid, row by row from the upper left."""

    shape: Literal["grid"] = Field(description="shape of the formation")
    rows: int = Field(ge=1, le=MOST_ROBOTS, description="number of rows")
    columns: int = Field(ge=1, le=MOST_ROBOTS, description="robots in a row")
    side: Length = Field(description="distance between neighbours (m)")


class Slots(Section):
    """Explicit slots."""

    shape: Literal["slots"] = Field(description="shape of the formation")
    slots: tuple[Point, ...] = Field(
        strict=False, min_length=1, description="slot h_i of each robot relative to the formation centre (m)"
    )


Shape = Annotated[Line | Polygon | Grid | Slots, Field(discriminator="shape")]


class RandomBox(Section):
    """Uniform in a square, then shifted so that the mean is exactly its middle."""

    seed: int = Field(ge=0, description="seed of NumPy's default generator")
    about: Point = Field(description="mean of the starting positions (m)")
    spread: Length = Field(description="half the side of the square (m)")


class RandomStart(Section):
    """Random starting positions."""

    random: RandomBox = Field(description="where, and by which seed")


class FormationStart(Section):
    """Starting positions in formation."""

    centre: Point = Field(description="formation centre; every robot starts in its slot about it (m)")


Start = Annotated[
    Annotated[tuple[Point, ...], Field(strict=False, min_length=1), Tag("positions")]
    | Annotated[RandomStart, Tag("random")]
    | Annotated[FormationStart, Tag("formation")],
    Discriminator(_start_kind),
]


class Robots(Section):
    """The plants (paper, Eq. 3)."""

    start: Start = Field(description="starting positions: a list (m), {random: ...} or {centre: ...}")
    radius: each(NonNegative) = Field(  # type: ignore[valid-type]
        default=0.0,
        description="radius of a robot's footprint (m), one for all or one a robot; paper: 0, a point",
    )


class Springs(Section):
    """The carried object as springs between robots (paper, Eq. 2)."""

    graph: Graph = Field(default="complete", description="which robots the object couples; paper: complete")


class DirectedChannel(Section):
    """A channel one way, with a weight."""

    speaker: int = Field(description="robot j that sends its state, from 1")
    listener: int = Field(description="robot i that hears it, from 1")
    weight: NonNegative = Field(default=1.0, description="γ_ij (1), how much it counts (Sec. 2.1); paper: 1")


def _channel_kind(value: Any) -> str:
    return "edge" if isinstance(value, list | tuple) else "directed"


def _named_or_channels(value: Any) -> str:
    return "channels" if isinstance(value, list | tuple) else "named"


Link = Annotated[
    Annotated[Edge, Tag("edge")] | Annotated[DirectedChannel, Tag("directed")], Discriminator(_channel_kind)
]
Channels = Annotated[
    Annotated[TopologyName, Tag("named")] | Annotated[tuple[Link, ...], Field(strict=False), Tag("channels")],
    Discriminator(_named_or_channels),
]
"""A communication graph: by name, or channel by channel."""


class Consensus(Section):
    """The communication between robots (paper, Eqs. 15-17)."""

    graph: Channels = Field(
        default="complete",
        description="which robots talk: a name, or edges [i, j] both ways and {speaker: j, listener: i, weight: γ_ij} "
        "one way; paper: complete",
    )
    channel: Annotated[Any, PartOf("channel")] = Field(
        default_factory=PartOf("channel").default, description="what becomes of a state on its way; paper: ideal"
    )
    medium: Annotated[Any, PartOf("medium")] = Field(
        default_factory=PartOf("medium").default,
        description="whether channels that carry packets compete for airtime, and how; paper: none",
    )


class Avoidance(Section):
    """Obstacles sensed during transport."""

    obstacles: tuple[Obstacle, ...] = Field(default=(), strict=False, description="the obstacles")


class Aggregation(Section):
    """The phase before the object is placed: no springs, no obstacles, slots about the mean of the starts."""

    duration: NonNegative = Field(
        default=0.0, description="T_agg (s), hand-off at its end; 0 starts at transport; inferred: 60, 30, 40"
    )


class Transport(Section):
    """The phase in which the object is carried to the goal."""

    goal: Point = Field(description="where the formation centre is carried to (m)")
    duration: Positive = Field(default=60.0, description="how long (s); chosen: 60")
    tolerance: Positive = Field(
        default=0.05, description="consensus error (m) beyond which the formation counts as lost; chosen: 0.05"
    )
    reference: Annotated[Any, PartOf("reference")] = Field(
        default_factory=PartOf("reference").default,
        description="where the formation centre should be on the way; inferred: a set point",
    )


class Simulation(Section):
    """Drake's ``SimulatorConfig``: the fields that every supported version of Drake has."""

    integration_scheme: str = Field(
        default="runge_kutta5",
        description="one of Drake's integration schemes; velocity_implicit_euler for one robot alone",
    )
    max_step_size: Positive = Field(
        default=0.1,
        description="largest step (s), or every step without error control; where obstacles are so small that such a "
        "step could leap over them, a run with error control is repeated with shorter ones",
    )
    accuracy: Positive = Field(
        default=1e-6,
        description="largest estimated error of any position (m) or velocity (m/s) in one step, not of the whole run: "
        "what errors grow to is up to the scenario, and run --check says; 1e-14 to what the scheme knows as its "
        "loosest, 1e-3 for runge_kutta5; has no effect without error control; chosen: 1e-6",
    )
    use_error_control: bool = Field(
        default=True,
        description="adapt the step to the accuracy; as in Drake, a scheme without error estimate (explicit_euler, "
        "runge_kutta2, semi_explicit_euler) takes fixed steps",
    )
    start_time: NonNegative = Field(default=0.0, description="time at which the scenario begins (s)")
    target_realtime_rate: NonNegative = Field(
        default=0.0, description="seconds simulated a second (1): 1 runs as fast as the clock, 0 as fast as it can"
    )


class Scenario(Section):
    """One experiment: the formation, its robots, their couplings and the task."""

    name: str = Field(
        pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$",
        description="short name, used for the output folder: letters, digits, and _ . - after the first",
    )
    description: str = Field(default="", description="what it shows")
    formation: Shape = Field(description="shape of the formation: a slot for every robot")
    robots: Annotated[Any, PartOf("robot", Robots)] = Field(description="the plants")
    object: Annotated[Any, PartOf("object")] = Field(
        default_factory=PartOf("object").default,
        description="what the carried object is: springs, as their section says, or a body of its own; paper: springs",
    )
    springs: Annotated[Any, PartOf("spring", Springs)] = Field(
        default_factory=PartOf("spring", Springs).default, description="the carried object where it is springs"
    )
    tracking: Annotated[Any, PartOf("tracking")] = Field(
        default_factory=PartOf("tracking").default, description="the local controllers"
    )
    consensus: Annotated[Any, PartOf("coordination", Consensus)] = Field(
        default_factory=PartOf("coordination", Consensus).default, description="what robots do with what they hear"
    )
    avoidance: Annotated[Any, PartOf("avoidance", Avoidance)] = Field(
        default_factory=PartOf("avoidance", Avoidance).default, description="obstacles, and what robots do about them"
    )
    sensor: Annotated[Any, PartOf("sensor")] = Field(
        default_factory=PartOf("sensor").default,
        description="how robots know their own states, which they also send; paper: ideal",
    )
    computer: Annotated[Any, PartOf("computer")] = Field(
        default_factory=PartOf("computer").default,
        description="when robots work out their control forces; paper: continuously",
    )
    actuator: Annotated[Any, PartOf("actuator")] = Field(
        default_factory=PartOf("actuator").default,
        description="what robots exert of the control forces asked of them; paper: ideal",
    )
    aggregation: Aggregation = Field(default=Aggregation(), description="how long robots gather before they carry")
    transport: Transport = Field(description="where to, how long and how the object is carried")
    failures: tuple[Failure, ...] = Field(default=(), strict=False, description="robots that fail; paper: none")
    seed: int = Field(
        default=0,
        ge=0,
        description="of all that is random in the scenario; every part draws from a stream of its own, named by its "
        "place in the diagram; chosen: 0",
    )
    simulator: Simulation = Field(default=Simulation(), description="how accurately all is integrated")

    @property
    def speaks_of_springs(self) -> bool:
        """Whether it says anything of them; an empty section does not."""
        return "springs" in self.model_fields_set and bool(self.springs.model_fields_set)

    @model_serializer(mode="wrap")
    def _as_it_may_be_written(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Without springs where the object is none."""
        written: dict[str, Any] = handler(self)
        if self.object.kind != SPRINGS and not self.speaks_of_springs:
            written.pop("springs", None)
        return written

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.scenario import scenario_html

        return scenario_html(self)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as what was written: sections follow the parts there are, and have no place in a module."""
        return type(self).model_validate, (self.model_dump(exclude_unset=True),)


def _follow_parts() -> None:
    """Make the sections anew, over the parts that there are now."""
    Consensus.model_rebuild(force=True)
    rebuild_sections()
    for section in (Transport, Scenario):
        section.model_rebuild(force=True)


when_changed(_follow_parts)
