"""Logarithmic scales where values range over decades."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from drake_formation.viz.figures.envelope import envelope

Array = NDArray[np.float64]
Series = tuple[Array, Array]
"""Sample times (s) and values, each of shape (samples,)."""

DECADES = 100.0
"""A scale is logarithmic where the largest value is so many times what is exceeded for nine tenths of all times."""
NOTHING = 1e-9
"""Less than this, in whichever unit, is rounding."""
SHOWN = 1e4
"""The largest value by the least that a logarithmic scale shows: a zero is crossed as deep as a sample hits it."""


def scale(axes: Axes, drawn: Sequence[Series], *, signed: bool = False) -> None:
    """Choose the scale of what is drawn over time.

    Args:
        axes: where.
        drawn: all that is drawn there.
        signed: below zero too; the scale is then linear about it.
    """
    peaks = [envelope(time, np.abs(values))[2] for time, values in drawn]
    there = np.concatenate([[], *peaks])
    there = there[there > NOTHING]
    axes.set_yscale("linear")
    if not len(there):
        axes.set(ylim=(-1.0, 1.0), yticks=[0.0])
        axes.text(0.5, 0.5, "zero throughout", transform=axes.transAxes, ha="center", va="bottom", color="0.4")
        return
    top, usual = float(there.max()), float(np.quantile(there, 0.1))
    bottom = max(usual / 2, top / SHOWN)
    if top < DECADES * usual:
        axes.set_ylim(-1.1 * top if signed else 0.0, 1.1 * top)
    elif signed:
        axes.set_yscale("symlog", linthresh=10.0 ** np.ceil(np.log10(bottom)))
        axes.set_ylim(-2 * top, 2 * top)
    else:
        axes.set_yscale("log")
        axes.set_ylim(bottom, 2 * top)
