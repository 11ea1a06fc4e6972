"""What a user may write in a scenario, field by field, with units and sources.

The models are strict: an unknown key, a number in quotes or a NaN is an error, never a guess. What concerns
one field alone is declared here; what concerns several fields at once is in :mod:`drake_formation.scenario.checks`.
Sources: *published* is printed in the paper, *inferred* follows from what it prints, *chosen* is this project's.
"""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from drake_formation.scenario.values import (
    CostMatrix,
    Gap,
    Graph,
    Known,
    Length,
    NonNegative,
    NonNegativeEach,
    Point,
    Positive,
    PositiveEach,
    Section,
)

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

    random: RandomBox


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

    start: Start = Field(description="starting positions: a list (m), {random: ...} or {centre: ...}; all at rest")
    mass: PositiveEach = Field(default=40.0, description="mass m_i (kg), one for all or one a robot; published: 40")


class Springs(Section):
    """The carried object as springs between robots (paper, Eq. 2)."""

    graph: Graph = Field(default="complete", description="which robots the object couples; paper: complete")
    law: Literal["hookean", "linear"] = Field(
        default="hookean", description="hookean acts along the line (Eq. 2); linear is the paper's Eqs. 4-7"
    )
    stiffness: NonNegativeEach = Field(
        default=1.45, description="k_ij (N/m), one for all or one an edge; published: 1.45 rubber, 3e4 steel"
    )
    damping: NonNegativeEach = Field(
        default=0.0, description="c_ij (N s/m), one for all or one an edge; published: none"
    )


class Tracking(Section):
    """The local LQR (paper, Eqs. 9-12)."""

    Q: CostMatrix = Field(
        default=1.0, description="state cost, 4 x 4: a number times I, a diagonal or a matrix; published: I"
    )
    R: CostMatrix = Field(
        default=1.0, description="input cost, 2 x 2: a number times I, a diagonal or a matrix; published: I"
    )
    feed_forward: bool = Field(
        default=False, description="add m_i a_r, the force that the reference's acceleration takes; published: none"
    )


class Consensus(Section):
    """The virtual springs over the communication graph (paper, Eqs. 15-17)."""

    graph: Graph = Field(default="complete", description="which robots talk, both ways; paper: complete")
    delta: NonNegative = Field(default=0.0, description="consensus gain δ (N/m); published: 0, 1e4, 2e4")
    delta_v: NonNegative = Field(default=0.0, description="velocity consensus gain δ_v (N s/m); paper: 0")


class Obstacle(Section):
    """A round obstacle; at radius 0 a point, as in the paper."""

    position: Point = Field(description="centre (m)")
    radius: NonNegative = Field(default=0.0, le=1e6, description="radius (m)")


class Avoidance(Section):
    """Khatib's repulsive potential around obstacles sensed during transport."""

    obstacles: tuple[Obstacle, ...] = Field(default=(), strict=False, description="the obstacles")
    range: Length = Field(default=1.3, description="sensing range ρ0 (m); inferred: 1.3")
    gain: NonNegative = Field(default=31.56, description="repulsive gain η (N m²); inferred: 31.56")
    sensing: Literal["in_range", "nearest"] = Field(
        default="in_range",
        description="in_range: every robot within range feels an obstacle; nearest: only the one nearest to it, not "
        "with the engine exponential; robots that stay equally near feel it in turns, in very short steps",
    )


class Aggregation(Section):
    """The phase before the object is placed: no springs, no obstacles, slots about the mean of the starts."""

    duration: NonNegative = Field(
        default=0.0, description="T_agg (s), hand-off at its end; 0 starts at transport; inferred: 60, 30, 40"
    )


class SetPointReference(Section):
    """The goal itself, from the hand-off on; what the published numbers come from."""

    kind: Literal["set_point"] = Field(description="kind of reference")


MotionDuration = Annotated[
    Positive | None,
    Field(
        description="how long the motion takes from the hand-off (s), the goal held afterwards; chosen: the "
        "transport's duration if not given"
    ),
]


class MinimumJerkReference(Section):
    """A straight line to the goal with the least jerk."""

    kind: Literal["minimum_jerk"] = Field(description="kind of reference")
    duration: MotionDuration = None


class WaypointsReference(Section):
    """A smooth curve through points, such as the paper's s-curve (Fig. 19)."""

    kind: Literal["waypoints"] = Field(description="kind of reference")
    points: tuple[Point, ...] = Field(
        strict=False,
        min_length=1,
        description="where the formation centre passes between where it gathers and the goal (m)",
    )
    duration: MotionDuration = None


class PotentialFieldReference(Section):
    """A way around known obstacles, planned by an artificial potential field before the run."""

    kind: Literal["potential_field"] = Field(description="kind of reference")
    known: Known = Field(
        default="all", description="which obstacles the plan knows, numbered from 1; robots sense all, known or not"
    )
    clearance: Gap = Field(
        default=1.3,
        description="what the plan keeps between formation and known obstacles (m), at least three quarters of it "
        "where smoothing cuts corners; chosen: 1.3, the sensing range, so that who follows the plan feels none",
    )
    reach: Gap = Field(
        default=2.6, description="clearance below which the plan gives way (m), more than clearance; chosen: 2.6"
    )
    duration: MotionDuration = None


Reference = Annotated[
    SetPointReference | MinimumJerkReference | WaypointsReference | PotentialFieldReference,
    Field(discriminator="kind"),
]
"""Where the formation centre should be during transport."""


class Transport(Section):
    """The phase in which the object is carried to the goal."""

    goal: Point = Field(description="where the formation centre is carried to (m)")
    duration: Positive = Field(default=60.0, description="how long (s); chosen: 60")
    reference: Reference = Field(
        default=SetPointReference(kind="set_point"),
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
        description="largest error of any position (m) or velocity (m/s) in one step, not of the whole run; 1e-14 to "
        "what the scheme knows as its loosest, 1e-3 for runge_kutta5; has no effect without error control",
    )
    use_error_control: bool = Field(
        default=True,
        description="adapt the step to the accuracy; as in Drake, a scheme without error estimate (explicit_euler, "
        "runge_kutta2, semi_explicit_euler) takes fixed steps",
    )
    start_time: NonNegative = Field(default=0.0, description="time at which the scenario begins (s)")
    target_realtime_rate: NonNegative = Field(
        default=0.0, description="1 runs as fast as the clock; 0 as fast as it can"
    )


class Scenario(Section):
    """One experiment: the formation, its robots, their couplings and the task."""

    name: str = Field(
        pattern=r"^[A-Za-z0-9][A-Za-z0-9_.-]*$",
        description="short name, used for the output folder: letters, digits, and _ . - after the first",
    )
    description: str = Field(default="", description="what it shows")
    formation: Shape = Field(description="shape of the formation: a slot for every robot")
    robots: Robots
    springs: Springs = Springs()
    tracking: Tracking = Tracking()
    consensus: Consensus = Consensus()
    avoidance: Avoidance = Avoidance()
    aggregation: Aggregation = Aggregation()
    transport: Transport
    simulator: Simulation = Simulation()
