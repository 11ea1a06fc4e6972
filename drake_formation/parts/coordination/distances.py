"""Consensus on distances: virtual springs along the lines between robots, and what channels they need."""

from collections.abc import Iterator

from drake_formation.config.errors import Fault
from drake_formation.formation.formation import Formation
from drake_formation.formation.rigidity import rigid_rank, rigidity_rank
from drake_formation.parts.springs.hookean import hookean_spring_force
from drake_formation.systems.scalars import Scalar


def distance_force(
    dx: Scalar, dy: Scalar, dvx: Scalar, dvy: Scalar, delta: Scalar, delta_v: Scalar, hx: Scalar, hy: Scalar
) -> tuple[Scalar, Scalar]:
    """One term of a consensus on distances: a virtual spring along the line between two robots.

    −(δ (1 − r/d) + δ_v ḋ/d) (q_i − q_j), with d = ‖q_i − q_j‖ and r = ‖h_i − h_j‖: the gradient of a structural
    potential ½ δ (d − r)² (Olfati-Saber and Murray, Distributed cooperative control of multiple vehicle formations
    using structural potential functions, IFAC World Congress 2002), by the law of the paper's springs (Eq. 2). It
    knows no direction, so it holds the shape and leaves the formation free to turn.

    Arguments and result as in :func:`drake_formation.parts.coordination.consensus.consensus_force`.
    """
    fx, fy = hookean_spring_force(dx, dy, dvx, dvy, delta, delta_v, hx, hy)
    return -fx, -fy


def flexible(formation: Formation) -> Iterator[Fault]:
    """What there is to say where distances over the channels do not hold the shape, by the section ``consensus``."""
    if "rank_of_channels" not in formation.kept:
        formation.kept["rank_of_channels"] = rigidity_rank(formation.slots, formation.channels.counted)
    rank, needed = formation.kept["rank_of_channels"], rigid_rank(formation.robots)
    if rank < needed:
        message = f"law hookean does not hold the shape: its channels hold {rank} independent distances"
        allowed = f"a graph that is rigid in the plane, with 2N - 3 = {needed} of them, or law linear"
        yield Fault(("graph",), message, allowed=allowed)
