"""The roles that parts play in a diagram: where each stands in a scenario, and which ports it may have."""

from dataclasses import dataclass

from drake_formation.config.errors import Path

STATE = 4
"""Numbers that robots tell each other: position q (m) and velocity v (m/s), in the world frame."""


TRAFFIC = ("sent", "lost", "delivered", "overtaken", "late", "sent_at")
"""What a channel of packets tells of itself: how many so far, and when the one in use was sent (s)."""


REPORT = 5
"""Numbers that a medium tells a channel: the packets carried last and before, when, and up to which it is done."""


@dataclass(frozen=True)
class Port:
    """A port by which the diagram knows a part.

    Attributes:
        name: its name; ``_j`` at its end stands for the number of another robot, from 1, one port a robot.
        size: how many numbers, or None where that depends on the scenario.
        meaning: what they are, with their unit.
        required: whether a part without it cannot play the role.
    """

    name: str
    size: int | None
    meaning: str
    required: bool = False

    def is_called(self, name: str) -> bool:
        """Whether a port of a block is this one."""
        stem, _, number = name.rpartition("_")
        return name == self.name or (self.name.endswith("_j") and f"{stem}_j" == self.name and number.isdecimal())


PHASE = Port("phase", 1, "0 aggregation, 1 transport")
OWN_STATE = Port("state", STATE, "the robot's state [q; v], as it takes it to be (m, m/s)")
REFERENCE = Port("reference", 6, "motion of the formation centre [p; ṗ; p̈] (m, m/s, m/s²)")
SENSED = Port("sensed", None, "for each obstacle 1 where no robot is nearer to it, else 0")
VISIBLE = Port("visible", None, "for each obstacle 1 where nothing stands between, else 0")
HEARD = Port("channel_j", STATE, "the state that robot j sends, for every robot heard (m, m/s)")
HELD = Port("spring_j", STATE, "the state of robot j, for every robot that the object couples (m, m/s)")
LOAD = Port("load", 2, "what an object that is a body of its own exerts on the robot (N)")
INTACT = Port("intact", None, "for each spring or grip that it has 1 until it breaks, else 0")
HELD_ON = Port("held", None, "for each spring or grip that it has 1 while it is held, else 0")
FAILURE = Port("failure", 3, "share of the control force it gives, 0 while it brakes or 1, and 1/τ of its brakes (1/s)")
FORCE = Port("force", 2, "control force (N)", required=True)
NOMINAL = Port("nominal", 2, "sum of the forces of the robot's controllers that do not ask for it (N)")
OBJECT = Port("spring_force", 2, "what the object exerts on the robot (N)")
DEMANDED = Port("demanded", 2, "force asked of the robot's actuators (N)")
APPLIED = Port("applied", 2, "force that the robot's actuators exert (N)")
KNOWN = (OWN_STATE, REFERENCE, PHASE, HEARD, SENSED, VISIBLE)
"""What any controller may ask for."""


@dataclass(frozen=True)
class Role:
    """What a part does for a formation.

    Attributes:
        name: of the role.
        section: where its configuration stands in a scenario.
        block: what its block is called, inside its robot where it is a robot's.
        default: the kind that counts where the scenario names none.
        owner: of whom there is one part each: ``robot``, ``edge``, ``channel``, or ``formation``.
        chooser: the key that names the kind.
        inputs: ports that the diagram can wire.
        outputs: ports that others read.
    """

    name: str
    section: Path
    block: str
    default: str
    owner: str
    inputs: tuple[Port, ...] = ()
    outputs: tuple[Port, ...] = ()
    chooser: str = "kind"


ROLES: dict[str, Role] = {
    role.name: role
    for role in (
        Role(
            "robot",
            ("robots",),
            "plant",
            "point_mass",
            "robot",
            (FORCE, PHASE, HELD, LOAD, INTACT, HELD_ON, FAILURE),
            (
                Port("state", STATE, "position and velocity where it holds the object (m, m/s)", required=True),
                Port("spring_force", 2, "what the object exerts on the robot (N)", required=True),
                Port("acceleration", 2, "of where it holds the object, unless that is the forces by its mass (m/s²)"),
                Port("heading", 1, "of its body, from +x counter-clockwise, if it has one (rad)"),
            ),
        ),
        Role("spring", ("springs",), "", "hookean", "edge", chooser="law"),
        Role(
            "tracking",
            ("tracking",),
            "tracking",
            "lqr",
            "robot",
            (*KNOWN, DEMANDED, APPLIED),
            (FORCE, Port("error", STATE, "tracking error x − x_r (m, m/s)", required=True)),
        ),
        Role("coordination", ("consensus",), "consensus", "consensus", "robot", KNOWN, (FORCE,)),
        Role("avoidance", ("avoidance",), "avoidance", "khatib", "robot", (*KNOWN, NOMINAL, OBJECT), (FORCE,)),
        Role(
            "sensor",
            ("sensor",),
            "sensor",
            "ideal",
            "robot",
            (Port("true_state", STATE, "the robot's state [q; v], as it is (m, m/s)"), DEMANDED),
            (Port("measured", STATE, "what the robot takes for its state (m, m/s)", required=True),),
        ),
        Role(
            "computer",
            ("computer",),
            "computer",
            "continuous",
            "robot",
            (Port("asked", 2, "sum of the forces of the robot's controllers (N)", required=True),),
            (Port("demanded", 2, "force asked of the robot's actuators (N)", required=True),),
        ),
        Role(
            "actuator",
            ("actuator",),
            "actuator",
            "ideal",
            "robot",
            (Port("demanded", 2, "force asked of the robot's actuators (N)", required=True),),
            (Port("force", 2, "force that they exert (N)", required=True),),
        ),
        Role(
            "reference",
            ("transport", "reference"),
            "reference",
            "set_point",
            "formation",
            (PHASE,),
            (Port("centre", 6, "motion of the formation centre [p; ṗ; p̈] (m, m/s, m/s²)", required=True),),
        ),
        Role(
            "object",
            ("object",),
            "object",
            "springs",
            "formation",
            (Port("state_j", STATE, "the state of robot j, for every robot (m, m/s)"), PHASE, INTACT, HELD_ON),
            (
                Port("grip_force_j", 2, "what it exerts on robot j, zero during aggregation (N)", required=True),
                Port("pose", 6, "place of its centre, heading, and their rates (m, rad, m/s, rad/s)", required=True),
                Port("strain", 1, "how far it is strained, as a share of its size (1)", required=True),
                Port("nodes", None, "places of the nodes of a grid, row by row, x and y of each, if it has them (m)"),
            ),
        ),
        Role(
            "channel",
            ("consensus", "channel"),
            "channel",
            "ideal",
            "channel",
            (
                Port("sent", STATE, "the state of the robot that speaks (m, m/s)", required=True),
                Port("own", STATE, "the state of the robot that listens (m, m/s)"),
                Port("through", REPORT, "what the medium, where channels share one, has carried of its packets (1, s)"),
                PHASE,
            ),
            (
                Port("received", STATE, "what the listening robot takes for it (m, m/s)", required=True),
                Port("traffic", len(TRAFFIC), "packets sent, lost, delivered, overtaken, late; when the last was sent"),
            ),
        ),
        Role(
            "medium",
            ("consensus", "medium"),
            "medium",
            "none",
            "formation",
            (
                Port("traffic_j", None, "what channel j, counted as they are listed, tells of its packets"),
                Port("state_j", STATE, "the state of robot j, for every robot (m, m/s)"),
            ),
            (
                Port("through_j", REPORT, "what it has carried of channel j's packets (1, s)", required=True),
                Port(
                    "airtime", 5, "packets offered, carried, dropped; frames that collided; airtime of all frames (s)"
                ),
            ),
        ),
    )
}
"""By name."""

CONTROLLERS = ("tracking", "coordination", "avoidance")
"""Roles whose forces on a robot add up to its control, in this order."""

WIRES = ("sensor", "computer", "actuator")
"""Roles of a robot whose parts need no block: what would enter it then goes on as it is."""
