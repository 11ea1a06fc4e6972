"""The axes of a sweep's figures: what runs along them, on which scale, and what they are called."""

import re

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from numpy.typing import NDArray

Numbers = NDArray[np.float64]

SYMBOLS = {
    "tracking_error_m": r"$\|\varepsilon_i\|$",
    "consensus_error_m": r"$\|e_i\|$",
    "peak_force_n": r"$\|u_i\|$",
    "max_spring_strain": r"$|d_{ij}/r_{ij} - 1|$",
}
"""Of what is measured, as the paper writes it."""

_WIDE = 100.0
"""Ratio between the largest and the least value from which on a logarithmic scale shows more."""


def followed(metric: xr.DataArray, dim: str) -> xr.DataArray:
    """What to draw a dimension by: its own values or, where these are but numbers, the first field along it."""
    own = metric[dim]
    if own.attrs.get("kind") != "zip" or not is_numeric(own):
        return own
    fields = [c for name, c in metric.coords.items() if name != dim and c.dims == (dim,) and is_numeric(c)]
    return next((field for field in fields if np.unique(field).size == field.size), own)


def is_numeric(coordinate: xr.DataArray) -> bool:
    """Whether it has values to draw at, not names."""
    return coordinate.dtype.kind in "if"


def is_wide(values: Numbers) -> bool:
    """Whether positive values span decades."""
    known = values[np.isfinite(values)]
    return bool(len(known) and known.min() > 0 and known.max() >= _WIDE * known.min())


def places_of(coordinate: xr.DataArray) -> Numbers:
    """Where to draw: numbers at their values, names one after another."""
    return coordinate.values.astype(float) if is_numeric(coordinate) else np.arange(float(coordinate.size))


def texts_of(coordinate: xr.DataArray) -> list[str]:
    """What to write at each place."""
    if is_numeric(coordinate):
        return [f"{value:.4g}".replace("e+0", "e") for value in coordinate.values]
    return [text if len(text) <= 36 else f"{text[:35]}…" for text in map(str, coordinate.values)]


def scale_axis(axes: Axes, letter: str, coordinate: xr.DataArray) -> None:
    """Label the x or y axis and choose its scale: logarithmic where values span decades, about zero too."""
    axis: Axis = getattr(axes, f"{letter}axis")
    set_scale = getattr(axes, f"set_{letter}scale")
    axis.set_label_text(label_of(coordinate))
    places = places_of(coordinate)
    if not is_numeric(coordinate):
        axis.set_ticks(places, texts_of(coordinate))
        if letter == "x" and max(map(len, texts_of(coordinate))) > 8:
            axis.set_tick_params(rotation=30)
        return
    if coordinate.attrs.get("scale", "log") == "linear":
        return
    positive = places[places > 0]
    if is_wide(places):
        set_scale("log")
    elif places.min() == 0 and is_wide(positive):
        set_scale("symlog", linthresh=positive.min())


def edges_of(axis: Axis, places: Numbers) -> Numbers:
    """Borders of cells about places, halfway on the axis' scale."""
    scale = axis.get_transform()
    order = scale.transform(places)
    if len(order) == 1:
        return np.asarray(places[0] + np.array([-0.5, 0.5]) * (abs(places[0]) or 1.0))
    middles = (order[:-1] + order[1:]) / 2
    borders = np.concatenate([[2 * order[0] - middles[0]], middles, [2 * order[-1] - middles[-1]]])
    return np.asarray(scale.inverted().transform(borders))


def label_values(axes: Axes, metric: xr.DataArray) -> None:
    """Label the y axis by a metric, and begin it at zero or, where values span decades, make it logarithmic."""
    axes.set_ylabel(label_of(metric))
    if is_wide(metric.values):
        axes.set_yscale("log")
    else:
        axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]) if np.nanmin(metric.values) >= 0 else None)


def name_of(variable: xr.DataArray) -> str:
    """What it is called, with its symbol if it has one."""
    words = str(variable.attrs.get("long_name", variable.name))
    symbol = SYMBOLS.get(str(variable.name), "")
    return f"{_typeset(words)} {symbol}".rstrip()


def label_of(variable: xr.DataArray) -> str:
    """Its name and, if it has one, its unit."""
    units = variable.attrs.get("units", "1")
    return name_of(variable) if units == "1" else f"{name_of(variable)} ({units})"


def _typeset(words: str) -> str:
    """Words with symbols such as k_ij as they are printed."""
    return re.sub(r"(?<!\w)(\w)_(\w+)", r"$\1_{\2}$", words)
