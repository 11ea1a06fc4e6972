"""Time series of a run on a common time grid."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drake_formation.simulation.series import Series

Array = NDArray[np.float64]


def sample_times(duration: float, every: float) -> Array:
    """Times since the beginning of a run at which it is sampled (s): all multiples of an interval that fit."""
    return every * np.arange(np.floor(duration / every * (1 + 1e-12)) + 1)


def sample(series: Series, variables: Sequence[str], every: float) -> dict[str, Array]:
    """Sample vectors of a run.

    Positions come from the cubic that also has the recorded velocities, everything else from shape-preserving cubics
    (Fritsch and Carlson, 1980), each phase by itself: forces jump at the hand-off.

    Args:
        series: from :meth:`drake_formation.simulation.PreparedRun.run`.
        variables: names of variables over time, robot and axis.
        every: sampling interval (s).

    Returns:
        Arrays of shape (samples, robots, 2), by variable; the first sample is the beginning of the run.
    """
    times = series["time"]
    wanted = times[0] + sample_times(times[-1] - times[0], every)
    carried = series["phase"] == 1
    hand_off = times[carried][0] if carried.any() else np.inf
    sampled = {name: np.empty((len(wanted), *series[name].shape[1:])) for name in variables}
    for recorded, asked in ((~carried, wanted < hand_off), (carried, wanted >= hand_off)):
        for name in variables:
            sampled[name][asked] = _at(series, name, recorded, wanted[asked])
    return sampled


def _at(series: Series, name: str, recorded: NDArray[np.bool_], wanted: Array) -> Array:
    """A variable at given times, from the samples of one phase."""
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    times, values = series["time"][recorded], series[name][recorded]
    if not len(wanted) or np.isnan(values).any():  # the deviation is not defined before the hand-off
        return np.full((len(wanted), *values.shape[1:]), np.nan)
    if len(times) == 1:
        return np.repeat(values, len(wanted), axis=0)
    if name == "position":
        curve = CubicHermiteSpline(times, values, series["velocity"][recorded])
    else:
        curve = PchipInterpolator(times, values)
    sampled: Array = curve(wanted)
    return sampled
