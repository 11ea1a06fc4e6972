"""The figures of a run, over the transport phase, between its samples too."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.metrics import Metrics, length_of
from drake_formation.scenario import resolve
from drake_formation.simulation.clearance import least_clearance
from drake_formation.simulation.extremes import Vectors, last_beyond, longest, shortest
from drake_formation.simulation.laws import control_law
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.series import Series
from drake_formation.systems.consensus_error import consensus_errors

Array = NDArray[np.float64]

SETTLED = 0.02
"""A robot has settled when it stays within this share of the distance to the goal."""
SETTLED_AT_LEAST = 1e-3
"""It need not come nearer than this (m), also where the goal is where the formation is already."""


def measured(series: Series) -> Metrics:
    """The figures of a run; see :func:`drake_formation.metrics.measure`."""
    transport = series["phase"] == 1
    if not transport.any():
        raise ValueError("the result has no transport phase to measure")
    formation = resolve(series.scenario)
    with np.errstate(over="ignore", invalid="ignore"):  # as in lengths
        robots = _motion(series, transport, "position", "velocity", "acceleration")
        deviation = _motion(series, transport, "deviation", "deviation_velocity", "deviation_acceleration")
        bulge = robots.bulge()
        return Metrics(
            tracking_error_m=[float(x) for x in longest(Vectors.of_positions(deviation, deviation.bulge()), each=True)],
            consensus_error_m=float(longest(_consensus_errors(robots, bulge, series["slot"]))[0]),
            peak_force_n=float(longest(_control_forces(robots, series["control_force"][transport], formation))[0]),
            min_clearance_m=least_clearance(robots, bulge, series["obstacle_position"], series["obstacle_radius"]),
            max_spring_strain=_strain(robots, bulge, formation),
            settling_time_s=_settling_time(robots, bulge, series),
        )


def _motion(series: Series, samples: NDArray[np.bool_], *names: str) -> Motion:
    return Motion(series["time"][samples], *(series[name][samples] for name in names))


def _consensus_errors(robots: Motion, bulge: Array, slots: Array) -> Vectors:
    return Vectors.of_positions(
        robots, bulge + bulge.mean(axis=1, keepdims=True), lambda position: consensus_errors(position, slots)
    )


def _control_forces(robots: Motion, recorded: Array, formation: Formation) -> Vectors:
    """Control forces as recorded (N), and by the blocks' laws in between.

    They have no second derivatives to go by. A step's chord is taken to be left by twice what it is half-way.
    """
    law = control_law(formation, robots.times, recorded)
    steps = np.arange(len(robots.times) - 1)
    position, velocity, _ = robots.at(steps, np.full((len(steps), 1), 0.5))
    middle = law(0.5 * (robots.times[:-1] + robots.times[1:]), position[:, 0], velocity[:, 0])
    return Vectors(robots, law, recorded, length_of(recorded[:-1] - 2 * middle + recorded[1:]))


def _strain(robots: Motion, bulge: Array, formation: Formation) -> float | None:
    """Largest share by which any spring is longer or shorter than at rest, or None."""
    first, second = formation.springs.pairs.T
    if not len(first):
        return None
    rest_lengths = formation.rest_lengths

    def lengths(position: Array) -> Array:
        return (position[..., first, :] - position[..., second, :]) / rest_lengths[:, None]

    shares = Vectors.of_positions(robots, (bulge[:, first] + bulge[:, second]) / rest_lengths, lengths)
    return float(max(longest(shares)[0] - 1, 1 - shortest(shares)[0]))


def _settling_time(robots: Motion, bulge: Array, series: Series) -> float | None:
    """Time from the start of the transport until every robot stays near its slot at the goal (s), or None."""
    travelled = float(length_of(series["goal"] - series["aggregation_centre"]))
    goals = series["slot"] + series["goal"]
    short = Vectors.of_positions(robots, bulge, lambda position: position - goals)
    last = last_beyond(short, max(SETTLED * travelled, SETTLED_AT_LEAST))
    if last is None:
        return 0.0
    step, share = last
    if step == len(robots.times) - 1:
        return None
    return float(robots.times[step] + share * (robots.times[step + 1] - robots.times[step]) - robots.times[0])
