"""Gains for a formation: what each way of choosing them advises, side by side."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from drake_formation.analysis.gains.distributed_lqr import DistributedLqr, distributed_lqr, relative_cost_of
from drake_formation.analysis.gains.force_limited_gain import ForceLimited, largest_gain
from drake_formation.analysis.gains.quadratic_cost import HAND_OFF_ERROR, HandOffCost
from drake_formation.analysis.gains.tuning import Tuned, tune, weight_of
from drake_formation.analysis.gains.velocity_gain import VelocityGain, velocity_gain
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.response.worst_case_force import WorstCaseForce, require_distances, worst_case_force

Answer = TypeVar("Answer")


@dataclass(frozen=True)
class DesignAdvice:
    """What four ways of design say to a formation; None where a question has no answer.

    Attributes:
        hand_off_error_m: hand-off error of every robot that efforts and forces are for (m).
        velocity: δ_v for the requested damping ratio at the scenario's δ.
        distributed: distributed LQR whose δ is about the scenario's, or with the tracking's own cost where that is 0.
        present_error: error with the scenario's gains (m² s), see :class:`Tuned`.
        present_effort: its effort (N² s).
        tuned: the best gains where effort is worth what the scenario's δ makes of it.
        peak: the worst force with the scenario's gains.
        force_limited: the largest δ under the force limit; None also where none is given.
        unanswered: why, by the name of the field, for each question without an answer.
    """

    hand_off_error_m: float
    velocity: VelocityGain | None
    distributed: DistributedLqr | None
    present_error: float | None
    present_effort: float | None
    tuned: Tuned | None
    peak: WorstCaseForce | None
    force_limited: ForceLimited | None
    unanswered: dict[str, str]

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        parts = {name: getattr(self, name) for name in ("velocity", "distributed", "tuned", "peak", "force_limited")}
        return {
            "hand_off_error_m": self.hand_off_error_m,
            "present_error_m2_s": self.present_error,
            "present_effort_n2_s": self.present_effort,
            **{name: part and part.to_dict() for name, part in parts.items()},
            "unanswered": self.unanswered,
        }


def design(
    formation: LinearFormation,
    *,
    damping_ratio: float = 0.7,
    hand_off_error_m: float = HAND_OFF_ERROR,
    travel_m: float = 0.0,
    force_limit_n: float | None = None,
) -> DesignAdvice:
    """Advise on δ and δ_v.

    Args:
        formation: the linearized loop.
        damping_ratio: ζ wanted of the slowest consensus mode.
        hand_off_error_m: hand-off error of every robot (m): its size where the worst case counts, its root mean
            square where the mean does.
        travel_m: distance of the set point at the hand-off (m).
        force_limit_n: what an actuator can do (N); no force-limited design if not given.

    Raises:
        IllPosedError: a distance is none; what has no answer otherwise is in ``unanswered``.
    """
    unanswered: dict[str, str] = {}

    def asked(name: str, question: Callable[[], Answer]) -> Answer | None:
        try:
            return question()
        except IllPosedError as refusal:
            unanswered[name] = str(refusal)
        except np.linalg.LinAlgError as failure:
            unanswered[name] = f"the numbers of the scenario are too far apart in size to compute it ({failure})"
        return None

    require_distances(hand_off_error_m, travel_m)
    costs = HandOffCost(formation, hand_off_error_m)
    delta = formation.delta
    present = asked("present", lambda: costs.error_and_effort(delta, formation.delta_v))
    return DesignAdvice(
        hand_off_error_m=hand_off_error_m,
        velocity=asked("velocity", lambda: velocity_gain(formation, damping_ratio=damping_ratio)),
        distributed=asked(
            "distributed",
            lambda: distributed_lqr(formation, relative_cost=relative_cost_of(formation, delta) if delta else None),
        ),
        present_error=present and present[0],
        present_effort=present and present[1],
        tuned=asked(
            "tuned",
            lambda: tune(
                formation,
                effort_weight=weight_of(formation, delta),
                hand_off_error_m=hand_off_error_m,
                costs=costs,
            ),
        ),
        peak=asked("peak", lambda: worst_case_force(formation, hand_off_error_m=hand_off_error_m, travel_m=travel_m)),
        force_limited=None
        if force_limit_n is None
        else asked(
            "force_limited",
            lambda: largest_gain(
                formation, force_limit_n=force_limit_n, hand_off_error_m=hand_off_error_m, travel_m=travel_m
            ),
        ),
        unanswered=unanswered,
    )
