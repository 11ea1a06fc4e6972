"""What is faster than a pixel: the band between the least and the largest value in each column of a figure."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import maximum_filter1d, minimum_filter1d

from drake_formation.viz.figures.looks import Dashes

Array = NDArray[np.float64]

COLUMNS = 400
"""To which a band is resolved, no more than axes have pixels across."""
NEIGHBOURS = 3
"""Columns that are looked at together: one and those beside it."""
SAMPLES = 4
"""Drawn in a column, at the most, of what is slow in it."""


def windows(time: Array, series: Array, width: float) -> tuple[Array, Array, Array]:
    """The least and the largest value within each window of a width (s), after the windows' middles.

    Args:
        time: sample times (s), shape (samples,).
        series: values then, shape (samples,).
        width: of a window (s); the first begins at the first sample.
    """
    window = _window(time, width)
    starts = np.flatnonzero(np.diff(window, prepend=-1))
    middles = time[0] + (window[starts] + 0.5) * width
    return middles, np.minimum.reduceat(series, starts), np.maximum.reduceat(series, starts)


def envelope(time: ArrayLike, series: ArrayLike, count: int = COLUMNS) -> tuple[Array, Array, Array]:
    """A signal between its least and its largest values where it is fast, and as it is where it is slow.

    It is fast in a column where it turns as often as columns follow each other. Values in both neighbours then count
    too, so that what rings about so fast has smooth edges.

    Args:
        time: sample times (s), shape (samples,).
        series: values then, shape (samples,); those that are not finite are left out.
        count: columns from the first sample to the last.

    Returns:
        Times, lower and upper edge, which are the same where the signal is slow; each of shape (points,).
    """
    times, values = np.asarray(time, dtype=float), np.asarray(series, dtype=float)
    times, values = times[np.isfinite(values)], values[np.isfinite(values)]
    if len(times) <= count or times[-1] == times[0]:
        return times, values, values
    width = (times[-1] - times[0]) / count
    window = _window(times, width)
    starts = np.flatnonzero(np.diff(window, prepend=-1))
    middles, lowest, highest = windows(times, values, width)
    sizes = np.diff(starts, append=len(times))
    turns = np.convolve(np.add.reduceat(_turns(values), starts), np.ones(NEIGHBOURS), "same")
    fast = np.repeat(turns >= NEIGHBOURS, sizes)
    first = np.zeros(len(times), dtype=bool)
    first[starts] = True
    place = np.arange(len(times)) - np.repeat(starts, sizes)
    every = np.repeat(-(-sizes // SAMPLES), sizes)
    drawn = np.where(fast, first, place % every == 0)

    def of_columns(fast_ones: Array, slow_ones: Array) -> Array:
        return np.where(fast, np.repeat(fast_ones, sizes), slow_ones)[drawn]

    lower, upper = minimum_filter1d(lowest, NEIGHBOURS), maximum_filter1d(highest, NEIGHBOURS)
    return of_columns(middles, times), of_columns(lower, values), of_columns(upper, values)


def draw_band(
    axes: Axes,
    time: ArrayLike,
    series: ArrayLike,
    colour: Any,
    style: str | Dashes,
    label: str | None,
    *,
    magnitude: bool = False,
    opacity: float = 0.25,
) -> None:
    """A signal as a line where it is slow, and as the band that it fills where it is faster than a pixel.

    Args:
        axes: where.
        time: sample times, shape (samples,).
        series: the signal, shape (samples,).
        colour: of line and band.
        style: of the line.
        label: for the legend.
        magnitude: the line is the band's upper edge alone, not both.
        opacity: of the band.
    """
    times, low, high = envelope(time, series)
    axes.plot(times, high, color=colour, linestyle=style, label=label)
    if (low == high).all():
        return
    if not magnitude:
        axes.plot(times, low, color=colour, linestyle=style)
    axes.fill_between(times, low, high, color=colour, alpha=opacity, linewidth=0)


def _window(time: Array, width: float) -> NDArray[np.int_]:
    """Which window each sample is in, from 0; the last sample ends a window and begins none."""
    since = time - time[0]
    window: NDArray[np.int_] = np.minimum(since / width, np.ceil(since[-1] / width) - 1).clip(0).astype(int)
    return window


def _turns(values: Array) -> NDArray[np.int_]:
    """1 for each sample at which a signal turns, else 0."""
    signs = np.sign(np.diff(values))
    signs = signs[np.maximum.accumulate(np.where(signs != 0, np.arange(len(signs)), 0))]  # a rest is no turn
    return np.concatenate([[0], (signs[1:] * signs[:-1] < 0).astype(int), [0]])
