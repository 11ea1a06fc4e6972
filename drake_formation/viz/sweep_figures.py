"""Figures of a sweep over one or two axes: lines, heat maps, and the spread of random samples."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import NDArray

from drake_formation.viz.style import draw_each

Numbers = NDArray[np.float64]
Labels = NDArray[np.str_]

MOST_LINES = 10
"""More lines than this in one figure cannot be told apart."""

LABEL = "channel_label"
"""Name of the coordinate of a metric that has what the channel certificate says."""

BOUNDARIES = {
    "stable": ("white", "-", "certified stable up to here"),
    "unstable": ("red", "--", "certified unstable from here"),
}
"""Colour and style of the line about the points of a label, and what it is called."""

OUTLINED = [Stroke(linewidth=4, foreground="black"), Normal()]
"""So that a white line shows on white, in the legend."""

_WIDE = 100.0
"""Ratio between the largest and the least value from which on a logarithmic scale shows more."""


def write_sweep_figures(dataset: xr.Dataset, folder: Path, labels: Labels | None = None) -> dict[str, str]:
    """Draw every metric of a sweep over one or two axes as a PNG file; gives those that failed, and why.

    Args:
        dataset: from :func:`drake_formation.sweep.run_sweep`.
        folder: where; made if missing. Figures of metrics that are gone are removed.
        labels: as for :func:`metric_figure`.
    """
    wanted = {name: partial(metric_figure, dataset, name, labels) for name in sweep_metrics(dataset)}
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.png"):
        if old.stem not in wanted:
            old.unlink()
    return draw_each(wanted, folder)


def sweep_metrics(dataset: xr.Dataset) -> list[str]:
    """Metrics that can be drawn: over one or two axes, and known for at least one run."""
    swept = dataset["status"].dims
    drawable = {swept, (*swept, "robot")} if len(swept) <= 2 else set()
    return [
        str(name)
        for name, variable in dataset.data_vars.items()
        if variable.dims in drawable and variable.dtype.kind == "f" and bool(np.isfinite(variable).any())
    ]


def metric_figure(dataset: xr.Dataset, name: str, labels: Labels | None = None) -> Figure:
    """One metric over a sweep's axes: the largest of any robot where every robot has one.

    One axis of numbers gives a line, of names a point each. Two axes of numbers give a heat map; an axis of a few names
    beside one of numbers a line for each name. Random samples are shown by their distribution or, along another axis,
    by their median and the range of nine tenths.

    Args:
        dataset: over one or two axes.
        name: a metric.
        labels: of the channel certificate at every point, whose boundaries are drawn over a heat map; from
            :func:`drake_formation.sweep.channel_labels.channel_labels`.
    """
    metric = dataset[name].load()
    if labels is not None:
        metric = metric.assign_coords({LABEL: (dataset["status"].dims, labels)})
    if "robot" in metric.dims:
        metric = metric.max("robot", keep_attrs=True)
    metric = metric.where(np.isfinite(metric))
    for dim in map(str, metric.dims):  # lines and cells follow the numbers, in whatever order they were written
        if _is_numeric(along := _along(metric, dim)):
            metric = metric.isel({dim: np.argsort(along.values, kind="stable")})
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    _chosen(metric)(figure, metric)
    count = int((dataset["status"] == 2).sum())
    failed = f" ({count} of {dataset['status'].size} runs failed)" if count else ""
    figure.suptitle(f"{dataset.attrs['title']}: {_name(metric)}{failed}", fontsize="medium")
    return figure


def _chosen(metric: xr.DataArray) -> Callable[[Figure, xr.DataArray], None]:
    random = [str(dim) for dim in metric.dims if metric[dim].attrs.get("kind") == "random"]
    if len(random) == metric.ndim:
        return _draw_distribution
    if random:
        return _draw_spread
    if metric.ndim == 1:
        return _draw_lines
    named = [dim for dim in metric.dims if not _is_numeric(_along(metric, str(dim)))]
    if len(named) == 1 and metric.sizes[named[0]] <= MOST_LINES:
        return _draw_lines
    return _draw_heat_map


def _draw_lines(figure: Figure, metric: xr.DataArray) -> None:
    """A line over the axis of numbers, one for each name of the other axis."""
    axes = figure.subplots()
    dims = sorted(map(str, metric.dims), key=lambda dim: _is_numeric(_along(metric, dim)))
    across = _along(metric, dims[-1])
    lines = metric.transpose(*dims).values.reshape(-1, metric.sizes[dims[-1]])
    _scale_axis(axes, "x", across)
    # Names have no order for a line to follow.
    style = "o-" if _is_numeric(across) else "o"
    for k, line in enumerate(lines):
        label = _texts(_along(metric, dims[0]))[k] if len(dims) > 1 else None
        axes.plot(_places(across), line, style, markersize=4, linewidth=1.2, label=label, color=colormaps["tab10"](k))
    _label_values(axes, metric)
    if len(dims) > 1:
        _legend(axes, title=_name(_along(metric, dims[0])))


def _draw_heat_map(figure: Figure, metric: xr.DataArray) -> None:
    """The first axis upwards, the second to the right, each cell about its value."""
    axes = figure.subplots()
    up, right = (_along(metric, str(dim)) for dim in metric.dims)
    _scale_axis(axes, "x", right)
    _scale_axis(axes, "y", up)
    values = metric.values
    norm = LogNorm() if _is_wide(values) and np.nanmin(values) > 0 else None
    axes.set_facecolor("0.8")  # runs without a value
    x, y = _edges(axes.xaxis, _places(right)), _edges(axes.yaxis, _places(up))
    colours = axes.pcolormesh(x, y, np.ma.masked_invalid(values), norm=norm, cmap="viridis")
    figure.colorbar(colours, label=_label(metric))
    for axis, coordinate in ((axes.xaxis, right), (axes.yaxis, up)):
        if coordinate.size <= MOST_LINES:
            axis.set_ticks(_places(coordinate), _texts(coordinate))
            axis.set_ticks([], minor=True)
    if right.size > 4:
        axes.xaxis.set_tick_params(rotation=45)
    if np.isnan(values).any():
        axes.plot([], [], "s", color="0.8", markeredgecolor="0.5", label="no value")
    if LABEL in metric.coords:
        _draw_boundaries(axes, _places(right), _places(up), metric[LABEL].values)
    if axes.get_legend_handles_labels()[0]:
        axes.legend(fontsize="small", loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False, ncols=3)


def _draw_boundaries(axes: Axes, x: Numbers, y: Numbers, labels: Labels) -> None:
    """Lines half-way between points that have a label and their neighbours that have not."""
    for label, (colour, style, text) in BOUNDARIES.items():
        inside = labels == label
        if inside.all() or not inside.any():
            continue
        axes.contour(x, y, inside.astype(float), levels=[0.5], colors=colour, linestyles=style, linewidths=2.5)
        axes.plot([], [], style, color=colour, linewidth=2.5, label=text, path_effects=OUTLINED)


def _draw_distribution(figure: Figure, metric: xr.DataArray) -> None:
    """How many samples have which value; and the values over each field that was drawn."""
    drawn = [
        coordinate
        for name, coordinate in metric.coords.items()
        if name not in metric.dims
        and _is_numeric(coordinate)
        and not str(coordinate.attrs.get("path")).endswith("seed")
    ][:3]
    figure.set_size_inches(5 + 3.5 * len(drawn), 4)
    columns = np.atleast_1d(figure.subplots(1, 1 + len(drawn)))
    values = metric.values[np.isfinite(metric.values)]
    wide = _is_wide(values)
    bins = (np.geomspace if wide else np.linspace)(*_range(values), 31)
    columns[0].hist(values, bins=bins, color="tab:blue", edgecolor="white", linewidth=0.5)
    columns[0].axvline(float(np.median(values)), color="black", linewidth=1, label=f"median {np.median(values):.3g}")
    columns[0].set(xlabel=_label(metric), ylabel="runs", xscale="log" if wide else "linear")
    columns[0].legend(fontsize="small", frameon=False)
    for axes, coordinate in zip(columns[1:], drawn, strict=True):
        _scale_axis(axes, "x", coordinate)
        places, _ = xr.broadcast(coordinate, metric)
        axes.plot(places.transpose(*metric.dims).values.ravel(), metric.values.ravel(), ".", markersize=3, alpha=0.6)
        _label_values(axes, metric)


def _range(values: Numbers) -> tuple[float, float]:
    """Least and largest value, some way apart where they are all but the same."""
    least, largest = float(values.min()), float(values.max())
    room = 1e-6 * max(abs(least), abs(largest)) or 1e-6
    return (least, largest) if largest - least > room else (least - room, largest + room)


def _draw_spread(figure: Figure, metric: xr.DataArray) -> None:
    """Median of the samples and the range of nine tenths of them, along the other axis."""
    axes = figure.subplots()
    (samples,) = (dim for dim in metric.dims if metric[dim].attrs.get("kind") == "random")
    (other,) = (str(dim) for dim in metric.dims if dim != samples)
    across = _along(metric, other)
    values = metric.transpose(samples, other).values
    known = ~np.isnan(values).all(axis=0)
    low, middle, high = np.full((3, values.shape[1]), np.nan)
    low[known], middle[known], high[known] = np.nanquantile(values[:, known], [0.05, 0.5, 0.95], axis=0)
    _scale_axis(axes, "x", across)
    places = _places(across)
    if _is_numeric(across):
        axes.fill_between(places, low, high, color="tab:blue", alpha=0.2, linewidth=0, label="nine tenths")
        axes.plot(places, middle, "o-", color="tab:blue", markersize=4, linewidth=1.2, label="median")
    else:
        bars = np.array([middle - low, high - middle])
        axes.errorbar(places, middle, yerr=bars, fmt="o", color="tab:blue", capsize=4, label="median and nine tenths")
    _label_values(axes, metric)
    _legend(axes, title=f"{metric.sizes[samples]} samples")


def _along(metric: xr.DataArray, dim: str) -> xr.DataArray:
    """What to draw a dimension by: its own values or, where these are but numbers, the first field along it."""
    own = metric[dim]
    if own.attrs.get("kind") != "zip" or not _is_numeric(own):
        return own
    fields = [c for name, c in metric.coords.items() if name != dim and c.dims == (dim,) and _is_numeric(c)]
    return next((field for field in fields if np.unique(field).size == field.size), own)


def _is_numeric(coordinate: xr.DataArray) -> bool:
    return coordinate.dtype.kind in "if"


def _is_wide(values: Numbers) -> bool:
    """Whether positive values span decades."""
    known = values[np.isfinite(values)]
    return bool(len(known) and known.min() > 0 and known.max() >= _WIDE * known.min())


def _places(coordinate: xr.DataArray) -> Numbers:
    """Where to draw: numbers at their values, names one after another."""
    return coordinate.values.astype(float) if _is_numeric(coordinate) else np.arange(float(coordinate.size))


def _texts(coordinate: xr.DataArray) -> list[str]:
    if _is_numeric(coordinate):
        return [f"{value:.4g}".replace("e+0", "e") for value in coordinate.values]
    return [text if len(text) <= 36 else f"{text[:35]}…" for text in map(str, coordinate.values)]


def _scale_axis(axes: Axes, letter: str, coordinate: xr.DataArray) -> None:
    """Label the x or y axis and choose its scale: logarithmic where values span decades, about zero too."""
    axis: Axis = getattr(axes, f"{letter}axis")
    set_scale = getattr(axes, f"set_{letter}scale")
    axis.set_label_text(_label(coordinate))
    places = _places(coordinate)
    if not _is_numeric(coordinate):
        axis.set_ticks(places, _texts(coordinate))
        if letter == "x" and max(map(len, _texts(coordinate))) > 8:
            axis.set_tick_params(rotation=30)
        return
    if coordinate.attrs.get("scale", "log") == "linear":
        return
    positive = places[places > 0]
    if _is_wide(places):
        set_scale("log")
    elif places.min() == 0 and _is_wide(positive):
        set_scale("symlog", linthresh=positive.min())


def _edges(axis: Axis, places: Numbers) -> Numbers:
    """Borders of cells about places, halfway on the axis' scale."""
    scale = axis.get_transform()
    order = scale.transform(places)
    if len(order) == 1:
        return np.asarray(places[0] + np.array([-0.5, 0.5]) * (abs(places[0]) or 1.0))
    middles = (order[:-1] + order[1:]) / 2
    borders = np.concatenate([[2 * order[0] - middles[0]], middles, [2 * order[-1] - middles[-1]]])
    return np.asarray(scale.inverted().transform(borders))


def _label_values(axes: Axes, metric: xr.DataArray) -> None:
    axes.set_ylabel(_label(metric))
    axes.grid(alpha=0.3)
    if _is_wide(metric.values):
        axes.set_yscale("log")
    else:
        axes.set_ylim(bottom=min(0.0, axes.get_ylim()[0]) if np.nanmin(metric.values) >= 0 else None)


def _legend(axes: Axes, title: str) -> None:
    axes.legend(title=title, fontsize="small", frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def _name(variable: xr.DataArray) -> str:
    return str(variable.attrs.get("long_name", variable.name))


def _label(variable: xr.DataArray) -> str:
    units = variable.attrs.get("units", "1")
    return _name(variable) if units == "1" else f"{_name(variable)} ({units})"
