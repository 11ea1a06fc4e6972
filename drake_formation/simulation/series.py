"""What a run amounts to, as plain arrays over time, before it is labelled or measured."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from drake_formation.scenario import Scenario, resolve
from drake_formation.simulation.recorder import Recording
from drake_formation.systems.consensus_error import consensus_errors

Array = NDArray[np.float64]
Series = Mapping[str, Array]
"""Arrays by the names, and with the units and dimensions, of the labelled result's variables."""

FORCES = ("tracking_force", "consensus_force", "avoidance_force")


def time_series(scenario: Scenario, run: Recording, nominal: Recording | None) -> Series:
    """Everything that follows from what was recorded.

    Args:
        scenario: the scenario that ran.
        run: what was recorded, at least one sample.
        nominal: the obstacle-free response from the same hand-off state; the run itself where no obstacle is felt;
            None where the run never got there.

    Returns:
        The variables of :func:`drake_formation.simulation.result.labelled_result`, and ``time`` (s).
    """
    state = run.series("state")
    position = state[..., :2]
    formation = resolve(scenario)
    slots, obstacles = formation.slots, formation.obstacles
    first, second = formation.springs.pairs.T
    forces = {name: run.series(name) for name in FORCES}
    with np.errstate(over="ignore"):  # a run that diverged may end in numbers whose squares overflow
        lengths = np.linalg.norm(position[:, first] - position[:, second], axis=-1)
        clearance = np.linalg.norm(position[:, :, None] - obstacles[:, :2], axis=-1) - obstacles[:, 2]
    return {
        "time": run.times,
        "phase": run.phases,
        "position": position,
        "velocity": state[..., 2:],
        "tracking_error": run.series("tracking_error")[..., :2],
        "deviation": _deviation(run, state, nominal, formation.hand_off),
        "consensus_error": consensus_errors(position, slots),
        **forces,
        "control_force": np.sum(list(forces.values()), axis=0),
        "spring_length": lengths,
        "rest_length": formation.rest_lengths,
        "clearance": clearance,
        "slot": slots,
        "goal": formation.goal,
        "aggregation_centre": formation.centre,
        "obstacle_position": obstacles[:, :2],
        "obstacle_radius": obstacles[:, 2],
    }


def _deviation(run: Recording, state: Array, nominal: Recording | None, hand_off: float) -> Array:
    """Position relative to the obstacle-free response at the run's own times (m), NaN where there is none."""
    deviation = np.full_like(state[..., :2], np.nan)
    if nominal is None or len(nominal.times) < 2:
        return deviation
    times = nominal.times
    known = (run.times >= hand_off) & (run.times <= times[-1])
    if nominal is run:
        deviation[known & (run.times >= times[0])] = 0.0
        return deviation
    from scipy.interpolate import CubicHermiteSpline  # slow to import, and not needed to build a diagram

    free = nominal.series("state")
    response = CubicHermiteSpline(times, free[..., :2], free[..., 2:])
    deviation[known] = state[known][..., :2] - response(run.times[known])
    return deviation
