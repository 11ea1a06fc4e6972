"""What the analysis assumes of a formation's parts; asked for more, it answers with the reason."""

from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.formation.formation import Formation
from drake_formation.parts.coordination.consensus import Consensus
from drake_formation.parts.tracking.lqr import Lqr


def require_linear_consensus(formation: Formation) -> None:
    """Linear consensus with one δ and δ_v for all robots, over channels that are wires and weigh alike both ways.

    Raises:
        IllPosedError: it is another law, or differs between robots or directions.
    """
    for i, part in enumerate(formation.parts["coordination"]):
        if not isinstance(part, Consensus):
            raise IllPosedError(f"robot {i + 1} coordinates by {part.kind!r}; what is certified is consensus")
        if part.config.law != "linear":
            raise IllPosedError(f"robot {i + 1} has consensus.law {part.config.law!r}; what is certified is 'linear'")
    gains = {(part.config.delta, part.config.delta_v) for part in formation.parts["coordination"]}
    if len(gains) > 1:
        raise IllPosedError("robots have different consensus.delta or delta_v; what is certified is one for all")
    if not formation.channels.undirected:
        raise IllPosedError("channels go one way or weigh differently each way; what is certified goes both ways alike")
    if any(part.kind != "ideal" for part in formation.parts["channel"]):
        raise IllPosedError("channels are not ideal; what is certified are wires")


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
