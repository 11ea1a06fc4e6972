"""What the analysis assumes of a formation's parts; asked for more, it answers with the reason."""

import numpy as np

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.formation.formation import Formation
from drake_formation.parts.actuators.motor import MAX_FORCE, MotorActuator
from drake_formation.parts.coordination.consensus import Consensus
from drake_formation.parts.robots.point_mass import PointMass
from drake_formation.parts.roles import ROLES, WIRES
from drake_formation.parts.tracking.lqr import Lqr


def require_consensus(formation: Formation) -> None:
    """Consensus with one law, δ and δ_v for all robots, over channels that weigh alike both ways.

    Raises:
        IllPosedError: it is another law, or differs between robots or directions.
    """
    for i, part in enumerate(formation.parts["coordination"]):
        if not isinstance(part, Consensus):
            raise IllPosedError(f"robot {i + 1} coordinates by {part.kind!r}; what is certified is consensus")
    if len({part.config.law for part in formation.parts["coordination"]}) > 1:
        raise IllPosedError("robots have different consensus.law; what is certified is one for all")
    gains = {(part.config.delta, part.config.delta_v) for part in formation.parts["coordination"]}
    if len(gains) > 1:
        raise IllPosedError("robots have different consensus.delta or delta_v; what is certified is one for all")
    if not formation.channels.undirected:
        raise IllPosedError("channels go one way or weigh differently each way; what is certified goes both ways alike")


def require_displacements(formation: Formation, what: str) -> None:
    """Consensus that compares displacements (paper, Eq. 15).

    Args:
        formation: with consensus.
        what: what there is no answer to otherwise, such as "advice on gains".

    Raises:
        IllPosedError: it compares distances.
    """
    law = formation.parts["coordination"][0].config.law
    if law != "linear":
        raise IllPosedError(f"consensus.law is {law!r}, on distances; {what} is for 'linear', on displacements")


def require_springs(formation: Formation) -> None:
    """A carried object that is springs between robots, at rest where those are in their slots.

    Raises:
        IllPosedError: it is a body of its own, or tensioned.
    """
    if formation.has_body:
        (part,) = formation.parts["object"]
        raise IllPosedError(f"the carried object is {part.kind!r}; what is certified are springs")
    if not formation.at_rest_in_slots:
        raise IllPosedError("springs have tension in the slots; what is certified is a formation at rest there")


def require_free_masses(formation: Formation) -> None:
    """Robots that move as the forces on them by their mass say.

    Raises:
        IllPosedError: a robot moves in another way.
    """
    for i, part in enumerate(formation.parts["robot"]):
        if not isinstance(part, PointMass):
            raise IllPosedError(f"robot {i + 1} is a {part.kind!r}; what is certified are robots of kind 'point_mass'")
        if part.config.drag:
            raise IllPosedError(f"robot {i + 1} has a drag; what is certified has none")


def require_wires(formation: Formation) -> None:
    """Robots that know their states, work out their forces continuously, and exert them, up to a largest force.

    A largest force is not reached near rest, and what lies beyond is not covered anyway.

    Raises:
        IllPosedError: a robot's sensors, computer or actuators do anything else.
    """
    for role in WIRES:
        for i, part in enumerate(formation.parts[role]):
            if part.kind == ROLES[role].default or (isinstance(part, MotorActuator) and set(part.given) <= {MAX_FORCE}):
                continue
            wanted = f"'{ROLES[role].default}'" + (", or with a largest force alone" if role == "actuator" else "")
            raise IllPosedError(f"robot {i + 1} has {part.called()}; what is certified is {wanted}")


def require_start_at_rest(formation: Formation) -> None:
    """Robots that are at rest when the scenario begins.

    Raises:
        IllPosedError: a robot starts with a velocity.
    """
    for i in np.flatnonzero(formation.start_velocities.any(axis=1)):
        raise IllPosedError(f"robot {i + 1} starts with a velocity; the answer is for a start at rest")


def local_lqr(formation: Formation, robot: int) -> Lqr:
    """The local LQR of a robot.

    Raises:
        IllPosedError: the robot tracks by another law.
    """
    part = formation.parts["tracking"][robot]
    if not isinstance(part, Lqr):
        raise IllPosedError(f"robot {robot + 1} tracks by {part.kind!r}, which has no Q and R")
    return part


def same_lqr(formation: Formation) -> Lqr:
    """The local LQR that all robots have alike.

    Raises:
        IllPosedError: a robot tracks by another law, or with other weights.
    """
    parts = [local_lqr(formation, robot) for robot in range(formation.robots)]
    if any(part.config != parts[0].config for part in parts):
        raise IllPosedError("robots have different tracking.Q or R; the answer is for one of each")
    return parts[0]
