"""Peak forces of a scenario from its own starting positions, and the largest δ under a limit for them."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.analysis.gains.force_limited_gain import bisected, require_question
from drake_formation.analysis.linear.assumptions import require_displacements, require_start_at_rest
from drake_formation.analysis.linear.control_gains import ControlGains, control_gains
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import STATES, LinearFormation, linearize
from drake_formation.analysis.response.peak_norm import require_stable, supremum
from drake_formation.scenario import Scenario, resolve

Array = NDArray[np.float64]

HIGHEST = 1e7
"""A gain (N/m) beyond which nothing is looked for."""

ROUNDING = 1e-9
"""A consensus error (m) that is rounding."""


@dataclass(frozen=True)
class StartForce:
    """Peak forces of a scenario from its own starting positions, obstacles apart.

    Attributes:
        delta: consensus gain δ (N/m).
        hand_off_error_m: largest distance of a robot from its slot at the hand-off (m).
        consensus_error_m: largest consensus error at the hand-off (m).
        aggregation_n: what no robot's force exceeds while the formation gathers (N); 0 without aggregation.
        transport_n: what no robot's force exceeds from the hand-off on (N); as tight as the bound of
            :class:`WorstCaseForce`.
    """

    delta: float
    hand_off_error_m: float
    consensus_error_m: float
    aggregation_n: float
    transport_n: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values with units in the keys."""
        return {
            "delta_n_per_m": self.delta,
            "hand_off_error_m": self.hand_off_error_m,
            "consensus_error_m": self.consensus_error_m,
            "aggregation_n": self.aggregation_n,
            "transport_n": self.transport_n,
        }


def start_force(
    scenario: Scenario,
    *,
    delta: float | None = None,
    formation: LinearFormation | None = None,
    forces: ControlGains | None = None,
) -> StartForce:
    """The peak forces of a scenario's own run, obstacles apart, by the linear loop.

    Until the hand-off there are no springs and the loop is linear, so the hand-off error is exact; afterwards the
    springs are linearized.

    Args:
        scenario: what runs, towards a set point.
        delta: consensus gain δ (N/m); the scenario's if not given.
        formation: its linearization, where it is at hand already.
        forces: its force map, likewise.

    Raises:
        ScenarioError: the scenario is wrong.
        IllPosedError: its reference is a trajectory, its loop is unstable, a robot does not start at rest, or robots
            compare distances.
    """
    own = resolve(scenario)
    kind = own.parts["reference"][0].kind
    if kind != "set_point":
        raise IllPosedError(
            f"transport.reference is a {kind}: its force follows the motion planned; the "
            "peak after a step is for a set_point, and simulation gives the other"
        )
    require_start_at_rest(own)
    formation = formation or linearize(scenario)
    require_displacements(formation.resolved, "the force of a start")
    delta = formation.delta if delta is None else delta
    outputs = (forces or control_gains(formation)).at(delta, formation.delta_v)
    gathering = _without_springs(formation)
    start = _deviation(own.starts - own.slots - own.centre)
    at_hand_off, aggregation = start, 0.0
    if own.aggregation_duration > 0:
        at_hand_off = _moved(gathering, delta, own.aggregation_duration) @ start
        aggregation = _peak(gathering, delta, outputs, start)
    error = at_hand_off.reshape(-1, STATES)[:, :2]
    travelling = at_hand_off + _deviation(np.tile(own.centre - own.goal, (formation.robots, 1)))
    return StartForce(
        delta=delta,
        hand_off_error_m=float(np.linalg.norm(error, axis=1).max()),
        consensus_error_m=float(np.linalg.norm(error - error.mean(axis=0), axis=1).max()),
        aggregation_n=aggregation,
        transport_n=_peak(formation, delta, outputs, travelling),
    )


def start_limited_gain(scenario: Scenario, *, force_limit_n: float, aggregation: bool = False) -> StartForce:
    """The largest δ with which a scenario's own run stays under a force, obstacles apart.

    The hand-off error is what the aggregation leaves, which depends on δ itself. Gains are raised from 0 by steps of
    a tenth until the limit is exceeded, and the crossing is refined.

    Args:
        scenario: what runs, towards a set point.
        force_limit_n: what an actuator can do (N).
        aggregation: whether the limit holds while the formation gathers, too, where errors are metres.

    Raises:
        ScenarioError: the scenario is wrong.
        IllPosedError: one robot, a graph that is not connected, no positive limit, a trajectory for a reference, an
            unstable loop, a limit that is exceeded without consensus, or one that no δ exceeds since the run has no
            consensus error.
    """
    formation = linearize(scenario)
    require_question(formation, force_limit_n)
    forces = control_gains(formation)

    def own(delta: float) -> StartForce:
        return start_force(scenario, delta=delta, formation=formation, forces=forces)

    def force(found: StartForce) -> float:
        return max(found.transport_n, found.aggregation_n) if aggregation else found.transport_n

    without = own(0.0)
    if force(without) > force_limit_n:
        raise IllPosedError(
            f"{force_limit_n:g} N is too little: the run takes {force(without):.4g} N without any position consensus "
            "(δ = 0)"
        )
    if without.consensus_error_m < ROUNDING and np.ptp(resolve(scenario).masses) == 0:
        raise IllPosedError(
            "the run has no consensus error, so no δ takes a force; largest_gain takes one to allow for"
        )
    good, bad = 0.0, 1.0
    while force(own(bad)) <= force_limit_n:
        good, bad = bad, 1.1 * bad
        if bad > HIGHEST:
            raise IllPosedError(f"no δ up to {HIGHEST:g} N/m takes more than {force_limit_n:g} N in this run")
    return bisected(own, lambda found: force(found) <= force_limit_n, good, bad)


def _deviation(positions: Array) -> Array:
    """Deviation of robots displaced (m, shape (N, 2)) and at rest, shape (4N,)."""
    return np.hstack([positions, np.zeros_like(positions)]).ravel()


def _without_springs(formation: LinearFormation) -> LinearFormation:
    return replace(formation, springs=np.zeros_like(formation.springs))


def _moved(formation: LinearFormation, delta: float, time: float) -> Array:
    """exp(A t), shape (4N, 4N)."""
    from scipy.linalg import expm

    loop = formation.closed_loop(delta, formation.delta_v)
    require_stable(loop, delta, formation.delta_v)
    result: Array = expm(loop * time)
    return result


def _peak(formation: LinearFormation, delta: float, outputs: Array, start: Array) -> float:
    """What no robot's force exceeds from one deviation on (N)."""
    column = np.column_stack([start, np.zeros_like(start)])
    return supremum(formation, delta, formation.delta_v, outputs, column, np.ones(1)).bound
