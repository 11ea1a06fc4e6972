"""The largest control force of the linear loop over all time and all hand-off errors of a given size.

Every robot may be displaced from its slot by up to a given distance in any direction, and the whole formation may be
some distance away from its set point; see :mod:`drake_formation.analysis.response.peak_norm` for how the bound is made.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.control_gains import ControlGains, control_gains
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation
from drake_formation.analysis.response.peak_norm import supremum

Array = NDArray[np.float64]


@dataclass(frozen=True)
class WorstCaseForce:
    """The worst case of the linear loop.

    Attributes:
        force_n: the force that the worst hand-off errors reach (N).
        bound_n: what no hand-off error of that size exceeds at any time (N).
        robot: the robot concerned, from 1.
        time_s: when after the hand-off (s).
        hand_off_errors: displacements of the robots from their slots that do it (m), shape (N, 2).
        travel: displacement of the whole formation from its set point that does it (m), shape (2,).
    """

    force_n: float
    bound_n: float
    robot: int
    time_s: float
    hand_off_errors: Array
    travel: Array

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "force_n": self.force_n,
            "bound_n": self.bound_n,
            "robot": self.robot,
            "time_s": self.time_s,
            "hand_off_errors_m": self.hand_off_errors.tolist(),
            "travel_m": self.travel.tolist(),
        }


def worst_case_force(
    formation: LinearFormation,
    *,
    hand_off_error_m: float,
    travel_m: float = 0.0,
    delta: float | None = None,
    delta_v: float | None = None,
    forces: ControlGains | None = None,
    enough_n: float = np.inf,
) -> WorstCaseForce:
    """The largest control force of any robot from the hand-off on, springs excluded.

    Args:
        formation: the linearized loop.
        hand_off_error_m: how far every robot may be from its slot (m), at rest, each in its own worst direction. The
            consensus error of the worst robot is then up to 2 (N − 1)/N times as large.
        travel_m: how far the formation is from its set point (m), in the worst direction.
        delta: consensus gain δ (N/m); the scenario's if not given.
        delta_v: velocity consensus gain δ_v (N s/m); the scenario's if not given.
        forces: from :func:`control_gains`, where it is at hand already.
        enough_n: a force (N) that is not looked beyond; once it is exceeded the bound is infinite.

    Raises:
        IllPosedError: the loop is unstable, or a distance is negative.
    """
    require_distances(hand_off_error_m, travel_m)
    delta = formation.delta if delta is None else delta
    delta_v = formation.delta_v if delta_v is None else delta_v
    outputs = (forces or control_gains(formation)).at(delta, delta_v)
    robots = formation.robots
    radii = np.append(np.full(robots, hand_off_error_m), travel_m)
    worst = supremum(formation, delta, delta_v, outputs, displacements(robots), radii, enough_n)
    return WorstCaseForce(worst.value, worst.bound, worst.robot + 1, worst.time, worst.weights[:-1], worst.weights[-1])


def require_distances(*distances: float) -> None:
    """Refuse what is not a distance."""
    for distance in distances:
        if not (np.isfinite(distance) and distance >= 0):
            raise IllPosedError(f"a hand-off error and a travel are distances, 0 m or more; {distance:g} m is none")


def displacements(robots: int) -> Array:
    """Deviations in blocks of two columns: each robot's position, then all together; shape (4N, 2N + 2)."""
    position = np.eye(STATES)[:, :2]
    result: Array = np.hstack([np.kron(np.eye(robots), position), np.kron(np.ones((robots, 1)), position)])
    return result
