"""Force-limited design: the largest δ whose peak force stays under what the actuators can do."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.linear.control_gains import ControlGains, control_gains
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation
from drake_formation.analysis.linear.well_posed import require_agreement
from drake_formation.analysis.response.worst_case_force import WorstCaseForce, require_distances, worst_case_force

Array = NDArray[np.float64]
Found = TypeVar("Found")

_RATIOS = (0.999, 0.995, 0.98, 0.95, 0.9, 0.8, 0.65, 0.5, 0.35, 0.2, 0.1, 0.03, 0.01, 0.001, 0.0)
"""Where below the ceiling a gain is looked for, from above."""

_RESOLUTION = 1e-3
"""How finely the largest gain is resolved, relative to it."""


@dataclass(frozen=True)
class ForceLimited:
    """The largest consensus gain under a force limit.

    Attributes:
        delta: the gain δ (N/m); no hand-off error of the given size makes any robot push harder than the limit.
        ceiling: a δ (N/m) above which the limit is exceeded at the hand-off itself; the largest gain lies between.
        delta_v: the velocity consensus gain it was found for (N s/m).
        force_limit_n: the limit (N).
        hand_off_error_m: size of every robot's hand-off error (m).
        travel_m: distance of the formation from its set point (m).
        peak: the worst case with that gain.
    """

    delta: float
    ceiling: float
    delta_v: float
    force_limit_n: float
    hand_off_error_m: float
    travel_m: float
    peak: WorstCaseForce

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "delta_n_per_m": self.delta,
            "ceiling_n_per_m": self.ceiling,
            "delta_v_n_s_per_m": self.delta_v,
            "force_limit_n": self.force_limit_n,
            "hand_off_error_m": self.hand_off_error_m,
            "travel_m": self.travel_m,
            "peak": self.peak.to_dict(),
        }


def largest_gain(
    formation: LinearFormation,
    *,
    force_limit_n: float,
    hand_off_error_m: float,
    travel_m: float = 0.0,
    delta_v: float | None = None,
) -> ForceLimited:
    """The largest δ with which no hand-off error of a given size makes any robot exceed a force.

    With a complete graph and little else the peak comes at the hand-off and is
    ``(2 (N − 1) δ + k_p) e + k_p D`` for hand-off errors e and travel D: robot i displaced one way, all others the
    other. In sparse graphs errors run through the graph and may meet later; the search is over all times. The peak
    at the hand-off is convex in δ, so above the ceiling the limit is surely exceeded; below it gains are tried from
    above, since the peak over all times need not grow with δ everywhere.

    Args:
        formation: the linearized loop.
        force_limit_n: what an actuator can do (N).
        hand_off_error_m: how far every robot may be from its slot at the hand-off (m), in its worst direction.
        travel_m: how far the set point is at the hand-off (m); 0 for a reference that starts where the formation is.
        delta_v: velocity consensus gain (N s/m); the scenario's if not given.

    Raises:
        IllPosedError: one robot, a graph that is not connected, a limit or an error that is not positive, an unstable
            loop, or a limit that is exceeded without any consensus.
    """
    require_question(formation, force_limit_n)
    require_distances(hand_off_error_m, travel_m)
    if hand_off_error_m == 0:
        raise IllPosedError(
            "a hand-off error of 0 m asks no force of consensus, so no δ is the largest; give an error above 0"
        )
    delta_v = formation.delta_v if delta_v is None else delta_v
    forces = control_gains(formation)

    def peak(delta: float) -> WorstCaseForce:
        return worst_case_force(
            formation,
            hand_off_error_m=hand_off_error_m,
            travel_m=travel_m,
            delta=delta,
            delta_v=delta_v,
            forces=forces,
            enough_n=force_limit_n,
        )

    ceiling = _ceiling(forces, force_limit_n, hand_off_error_m, travel_m)
    worse = ceiling
    for ratio in _RATIOS if ceiling > 0 else (0.0,):
        found = peak(ratio * ceiling)
        if found.bound_n <= force_limit_n:
            delta, found = bisected(
                lambda delta: (delta, peak(delta)),
                lambda pair: pair[1].bound_n <= force_limit_n,
                ratio * ceiling,
                worse,
            )
            return ForceLimited(delta, ceiling, delta_v, force_limit_n, hand_off_error_m, travel_m, found)
        worse = ratio * ceiling
    raise IllPosedError(
        f"{force_limit_n:g} N is too little: without any position consensus (δ = 0, δ_v = {delta_v:g} N s/m) a "
        f"hand-off error of {hand_off_error_m:g} m and a travel of {travel_m:g} m take {found.force_n:.4g} N or more"
    )


def require_question(formation: LinearFormation, force_limit_n: float) -> None:
    """Refuse a question about robots that cannot agree, or with a limit that is none."""
    require_agreement(formation, "consensus gain to limit")
    if not (np.isfinite(force_limit_n) and force_limit_n > 0):
        raise IllPosedError(f"a force limit is above 0 N; {force_limit_n:g} N is none")


def _ceiling(forces: ControlGains, limit: float, error: float, travel: float) -> float:
    """The δ at which the worst force at the hand-off itself is the limit (N/m); 0 where it is exceeded at δ = 0.

    At the hand-off robots are at rest, and the force of robot i is at least what displacements along one axis make.
    """
    from scipy.optimize import brentq

    def at_hand_off(delta: float) -> float:
        gains = forces.at(delta, 0.0)
        positions = gains.reshape(len(gains), -1, STATES)[:, :, :2]
        own = np.abs(positions).sum(axis=1) * error + np.abs(positions.sum(axis=1)) * travel
        rows = own.reshape(-1, 2, 2)
        return float(rows[:, [0, 1], [0, 1]].max())

    if at_hand_off(0.0) >= limit:
        return 0.0
    high = 1.0
    while at_hand_off(high) <= limit:
        high *= 2
    return float(brentq(lambda delta: at_hand_off(delta) - limit, 0.0, high, rtol=1e-12))


def bisected(evaluate: Callable[[float], Found], fits: Callable[[Found], bool], good: float, bad: float) -> Found:
    """Bisect between a gain that fits and one that does not, to a thousandth; the answer fits."""
    found = evaluate(good)
    while bad - good > _RESOLUTION * bad:
        middle = (good + bad) / 2
        candidate = evaluate(middle)
        if fits(candidate):
            good, found = middle, candidate
        else:
            bad = middle
    return found
