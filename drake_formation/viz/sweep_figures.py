"""Figures of a sweep over one or two axes: lines, heat maps, and the spread of random samples."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import NDArray

from drake_formation.viz.figures.looks import look
from drake_formation.viz.figures.panels import Width, drawing, height, legend
from drake_formation.viz.style import FORMATS, draw_each
from drake_formation.viz.sweep_axes import (
    edges_of,
    followed,
    is_numeric,
    is_wide,
    label_of,
    label_values,
    name_of,
    places_of,
    scale_axis,
    texts_of,
)

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


def write_sweep_figures(
    dataset: xr.Dataset, folder: Path, labels: Labels | None = None, file_format: str = "png"
) -> dict[str, str]:
    """Draw every metric of a sweep over one or two axes as a file; gives those that failed, and why.

    Args:
        dataset: from :func:`drake_formation.sweep.run_sweep`.
        folder: where; made if missing. Figures of metrics that are gone, or in another format, are removed.
        labels: as for :func:`metric_figure`.
        file_format: of the files.
    """
    wanted = {name: partial(metric_figure, dataset, name, labels) for name in sweep_metrics(dataset)}
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.iterdir():
        if old.suffix[1:] in FORMATS and (old.stem not in wanted or old.suffix[1:] != file_format):
            old.unlink()
    return draw_each(wanted, folder, file_format)


def sweep_metrics(dataset: xr.Dataset) -> list[str]:
    """Metrics that can be drawn: over one or two axes, and known for at least one run."""
    swept = dataset["status"].dims
    drawable = {swept, (*swept, "robot")} if len(swept) <= 2 else set()
    return [
        str(name)
        for name, variable in dataset.data_vars.items()
        if variable.dims in drawable and variable.dtype.kind == "f" and bool(np.isfinite(variable).any())
    ]


def metric_figure(
    dataset: xr.Dataset,
    name: str,
    labels: Labels | None = None,
    axes: Axes | Sequence[Axes] | None = None,
    *,
    width: Width = "page",
) -> list[Axes]:
    """One metric over a sweep's axes: the largest of any robot where every robot has one.

    One axis of numbers gives a line, of names a point each. Two axes of numbers give a heat map; an axis of a few names
    beside one of numbers a line for each name. Random samples are shown by their distribution or, along another axis,
    by their median and the range of nine tenths.

    Args:
        dataset: over one or two axes.
        name: a metric.
        labels: of the channel certificate at every point, whose boundaries are drawn over a heat map; from
            :func:`drake_formation.sweep.channel_labels.channel_labels`.
        axes: where to draw; a figure of their own if not given. They are one but where all axes of the sweep are
            random: then there is one more for each field that was drawn, up to three.
        width: of that figure.

    Raises:
        ValueError: more or fewer axes are given than there is to draw.
    """
    metric = dataset[name].load()
    if labels is not None:
        metric = metric.assign_coords({LABEL: (dataset["status"].dims, labels)})
    if "robot" in metric.dims:
        metric = metric.max("robot", keep_attrs=True)
    metric = metric.where(np.isfinite(metric))
    for dim in map(str, metric.dims):  # lines and cells follow the numbers, in whatever order they were written
        if is_numeric(along := followed(metric, dim)):
            metric = metric.isel({dim: np.argsort(along.values, kind="stable")})
    count = int((dataset["status"] == 2).sum())
    failed = f" ({count} of {dataset['status'].size} runs failed)" if count else ""
    title = f"{dataset.attrs['title']}: {name_of(metric)}{failed}"
    draw = _chosen(metric)
    columns = 1 + len(_drawn_fields(metric)) if draw is _draw_distribution else 1
    with drawing(axes, [height(width)], width, title=title, columns=columns) as panels:
        draw(panels, metric)
    return panels


def _chosen(metric: xr.DataArray) -> Callable[[Sequence[Axes], xr.DataArray], None]:
    random = [str(dim) for dim in metric.dims if metric[dim].attrs.get("kind") == "random"]
    if len(random) == metric.ndim:
        return _draw_distribution
    if random:
        return _draw_spread
    if metric.ndim == 1:
        return _draw_lines
    named = [dim for dim in metric.dims if not is_numeric(followed(metric, str(dim)))]
    if len(named) == 1 and metric.sizes[named[0]] <= MOST_LINES:
        return _draw_lines
    return _draw_heat_map


def _draw_lines(panels: Sequence[Axes], metric: xr.DataArray) -> None:
    """A line over the axis of numbers, one for each name of the other axis."""
    (axes,) = panels
    dims = sorted(map(str, metric.dims), key=lambda dim: is_numeric(followed(metric, dim)))
    across = followed(metric, dims[-1])
    lines = metric.transpose(*dims).values.reshape(-1, metric.sizes[dims[-1]])
    scale_axis(axes, "x", across)
    for k, line in enumerate(lines):
        label = texts_of(followed(metric, dims[0]))[k] if len(dims) > 1 else None
        its = look(k + 1)
        dashes = its.dashes if is_numeric(across) else "none"  # names have no order for a line to follow
        axes.plot(places_of(across), line, its.marker, linestyle=dashes, label=label, color=its.colour)
    label_values(axes, metric)
    if len(dims) > 1:
        legend(axes, heading=name_of(followed(metric, dims[0])))


def _draw_heat_map(panels: Sequence[Axes], metric: xr.DataArray) -> None:
    """The first axis upwards, the second to the right, each cell about its value."""
    (axes,) = panels
    up, right = (followed(metric, str(dim)) for dim in metric.dims)
    scale_axis(axes, "x", right)
    scale_axis(axes, "y", up)
    values = metric.values
    norm = LogNorm() if is_wide(values) and np.nanmin(values) > 0 else None
    axes.grid(visible=False)
    axes.set_facecolor("0.8")  # runs without a value
    x, y = edges_of(axes.xaxis, places_of(right)), edges_of(axes.yaxis, places_of(up))
    colours = axes.pcolormesh(x, y, np.ma.masked_invalid(values), norm=norm, cmap="viridis")
    axes.figure.colorbar(colours, ax=axes, label=label_of(metric))
    for axis, coordinate in ((axes.xaxis, right), (axes.yaxis, up)):
        if coordinate.size <= MOST_LINES:
            axis.set_ticks(places_of(coordinate), texts_of(coordinate))
            axis.set_ticks([], minor=True)
    if right.size > 4:
        axes.xaxis.set_tick_params(rotation=45)
    if np.isnan(values).any():
        axes.plot([], [], "s", color="0.8", markeredgecolor="0.5", label="no value")
    if LABEL in metric.coords:
        _draw_boundaries(axes, places_of(right), places_of(up), metric[LABEL].values)
    legend(axes, above=True)


def _draw_boundaries(axes: Axes, x: Numbers, y: Numbers, labels: Labels) -> None:
    """Lines half-way between points that have a label and their neighbours that have not."""
    for label, (colour, style, text) in BOUNDARIES.items():
        inside = labels == label
        if inside.all() or not inside.any():
            continue
        axes.contour(x, y, inside.astype(float), levels=[0.5], colors=colour, linestyles=style, linewidths=2.5)
        axes.plot([], [], style, color=colour, linewidth=2.5, label=text, path_effects=OUTLINED)


def _draw_distribution(panels: Sequence[Axes], metric: xr.DataArray) -> None:
    """How many samples have which value; and the values over each field that was drawn."""
    values = metric.values[np.isfinite(metric.values)]
    wide = is_wide(values)
    bins = (np.geomspace if wide else np.linspace)(*_range(values), 31)
    panels[0].hist(values, bins=bins.tolist(), color="C0", edgecolor="white", linewidth=0.5)
    middle = float(np.median(values))
    panels[0].axvline(middle, color="black", linewidth=1, label=f"median {middle:.3g}")
    panels[0].set(xlabel=label_of(metric), ylabel="runs", xscale="log" if wide else "linear")
    legend(panels[0], above=True)
    for axes, coordinate in zip(panels[1:], _drawn_fields(metric), strict=True):
        scale_axis(axes, "x", coordinate)
        places, _ = xr.broadcast(coordinate, metric)
        axes.plot(places.transpose(*metric.dims).values.ravel(), metric.values.ravel(), ".", markersize=3, alpha=0.6)
        label_values(axes, metric)


def _drawn_fields(metric: xr.DataArray) -> list[xr.DataArray]:
    """The fields that random samples were drawn of, seeds left out; three at the most."""
    return [
        coordinate
        for name, coordinate in metric.coords.items()
        if name not in metric.dims and is_numeric(coordinate) and not str(coordinate.attrs.get("path")).endswith("seed")
    ][:3]


def _range(values: Numbers) -> tuple[float, float]:
    """Least and largest value, some way apart where they are all but the same."""
    least, largest = float(values.min()), float(values.max())
    room = 1e-6 * max(abs(least), abs(largest)) or 1e-6
    return (least, largest) if largest - least > room else (least - room, largest + room)


def _draw_spread(panels: Sequence[Axes], metric: xr.DataArray) -> None:
    """Median of the samples and the range of nine tenths of them, along the other axis."""
    (axes,) = panels
    (samples,) = (dim for dim in metric.dims if metric[dim].attrs.get("kind") == "random")
    (other,) = (str(dim) for dim in metric.dims if dim != samples)
    across = followed(metric, other)
    values = metric.transpose(samples, other).values
    known = ~np.isnan(values).all(axis=0)
    low, middle, high = np.full((3, values.shape[1]), np.nan)
    low[known], middle[known], high[known] = np.nanquantile(values[:, known], [0.05, 0.5, 0.95], axis=0)
    scale_axis(axes, "x", across)
    places = places_of(across)
    if is_numeric(across):
        axes.fill_between(places, low, high, color="C0", alpha=0.2, linewidth=0, label="nine tenths")
        axes.plot(places, middle, "o-", color="C0", label="median")
    else:
        bars = np.array([middle - low, high - middle])
        axes.errorbar(places, middle, yerr=bars, fmt="o", color="C0", capsize=4, label="median and nine tenths")
    label_values(axes, metric)
    legend(axes, heading=f"{metric.sizes[samples]} samples")
