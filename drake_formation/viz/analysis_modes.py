"""Figures of the closed loop's eigenvalues: the map of modes, and where they go as δ grows."""

from collections import Counter
from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.linear.motion_subspaces import PARTS
from drake_formation.analysis.stability.modes import Mode, Modes, decay_limit
from drake_formation.viz.figures.looks import COLOURS
from drake_formation.viz.figures.panels import Width, drawing, height, legend

STYLES = {
    "centre": ("o", COLOURS[0]),
    "rotation": ("D", COLOURS[1]),
    "stretch": ("^", COLOURS[2]),
    "consensus": ("s", COLOURS[6]),
}
"""Marker and colour of every kind of mode."""

DAMPING_RATIOS = (0.01, 0.1, 0.3, 0.7)
"""Lines of equal damping drawn behind the modes."""

MOST_LABELS = 12
"""More modes than this are not labelled one by one."""

LARGEST_DELTA = 2e4
"""A root locus goes at least to the largest of the paper's gains (N/m)."""

VALUES = 90
"""Values of δ in a root locus."""


def mode_map(modes: Modes, title: str, axes: Axes | None = None, *, width: Width = "page") -> Axes:
    """Every mode in the complex plane by kind, with its Laplacian eigenvalue; conjugates are left out.

    Args:
        modes: from :func:`drake_formation.analysis.stability.modes`.
        title: name of the scenario.
        axes: where to draw; a figure of their own if not given.
        width: of that figure.
    """
    with drawing(axes, [1.2 * height(width)], width, title=f"{title}: modes") as (panel,):
        _draw_plane(panel, [mode.eigenvalue for mode in modes.modes])
        for kind in PARTS:
            _draw_kind(panel, kind, [mode for mode in modes.modes if mode.kind == kind])
        _label(panel, modes.modes)
        panel.plot([], [], "o", color="0.4", fillstyle="none", label="open: consensus cannot move it")
        legend(panel, above=True)
    return panel


def root_locus(formation: LinearFormation, axes: Axes | None = None, *, width: Width = "page") -> Axes:
    """Where all eigenvalues go as δ grows from 0, at the scenario's δ_v; rings mark the scenario's own δ.

    Args:
        formation: the linearized closed loop.
        axes: where to draw; a figure of their own if not given.
        width: of that figure.
    """
    largest = max(LARGEST_DELTA, 2 * formation.delta)
    deltas = np.concatenate([[0.0], np.geomspace(1e-5 * largest, largest, VALUES)])
    loci = np.array([np.linalg.eigvals(formation.closed_loop(delta, formation.delta_v)) for delta in deltas])
    upper = loci.imag >= -1e-9
    shown = np.broadcast_to(np.maximum(deltas, deltas[1])[:, None], loci.shape)[upper]
    own = np.linalg.eigvals(formation.A)
    own = own[own.imag >= -1e-9]
    title = rf"{formation.scenario.name}: root locus, $\delta_v$ = {formation.delta_v:g} N s/m"
    with drawing(axes, [1.2 * height(width)], width, title=title) as (panel,):
        _draw_plane(panel, loci.ravel())
        scale = LogNorm(deltas[1], largest)
        dots = panel.scatter(loci.real[upper], loci.imag[upper], c=shown, s=7, cmap="viridis", norm=scale, zorder=3)
        panel.figure.colorbar(dots, ax=panel, label=r"consensus gain $\delta$ (N/m)")
        label = rf"the scenario's $\delta$ = {formation.delta:g} N/m"
        panel.plot(own.real, own.imag, "o", color="black", fillstyle="none", markersize=8, label=label, zorder=4)
        limit = decay_limit(formation)
        if limit is not None:
            text = rf"mean decay rate of what consensus moves, for every $\delta$: {limit:.4g} 1/s"
            panel.axvline(-limit, color=COLOURS[1], linestyle="--", linewidth=1, label=text)
        legend(panel, above=True)
    return panel


def _draw_plane(axes: Axes, values: Iterable[complex]) -> None:
    """The upper half of the complex plane about some eigenvalues; frequencies on a scale that reaches 0."""
    points = np.array(list(values))
    fastest = float(np.abs(points.imag).max())
    left, right = float(points.real.min()), float(points.real.max())
    reach = max(abs(left), abs(right))
    axes.set_xlim(min(left, 0.0) - 0.35 * reach, max(right, 0.0) + 0.2 * reach)
    axes.set_yscale("symlog", linthresh=_smallest_frequency(points), linscale=0.5)
    axes.set_ylim(-0.3 * _smallest_frequency(points), 3 * max(fastest, _smallest_frequency(points)))
    axes.axvspan(0, axes.get_xlim()[1], color=COLOURS[1], alpha=0.1, linewidth=0, label="unstable")
    axes.axvline(0, color="0.3", linewidth=0.8)
    _draw_damping(axes)
    axes.set(xlabel=r"minus the decay rate $\mathrm{Re}\,s$ (1/s)", ylabel=r"frequency $\mathrm{Im}\,s$ (rad/s)")


def _smallest_frequency(points: NDArray[np.complex128]) -> float:
    """Frequencies below it are drawn on a linear scale: half the smallest, but at most three decades are shown."""
    frequencies = np.abs(points.imag)
    fastest = float(frequencies.max())
    moving = frequencies[frequencies > 1e-3 * fastest]
    return max(0.5 * float(moving.min()), 1e-3 * fastest) if fastest > 0 else 1.0


def _draw_damping(axes: Axes) -> None:
    left, top = -axes.get_xlim()[0], axes.get_ylim()[1]
    for ratio in DAMPING_RATIOS:
        slope = np.sqrt(1 - ratio**2) / ratio
        end = min(left, top / slope)
        decay = end * np.geomspace(1e-6, 1, 400)
        axes.plot(-decay, decay * slope, color="0.75", linewidth=0.8, zorder=1)
        across, along = ("left", "bottom") if end == left else ("right", "top")
        axes.text(-end, end * slope, f" ζ = {ratio:g} ", color="0.45", fontsize="x-small", ha=across, va=along)


def _draw_kind(axes: Axes, kind: str, modes: list[Mode]) -> None:
    marker, colour = STYLES[kind]
    for k, moved in enumerate((True, False)):
        shown = [mode for mode in modes if mode.moved_by_consensus == moved]
        axes.plot(
            [mode.eigenvalue.real for mode in shown],
            [mode.frequency for mode in shown],
            marker,
            color=colour,
            fillstyle="full" if moved else "none",
            markersize=6,
            alpha=0.8,
            label=kind if modes and k == (0 if modes[0].moved_by_consensus else 1) else None,
            zorder=3 if moved else 4,  # open markers are not hidden by others at the same place
        )


def _label(axes: Axes, modes: tuple[Mode, ...]) -> None:
    """Laplacian eigenvalues, and how often each occurs, beside the modes; modes at one place share a label."""
    places: dict[tuple[float, float], Counter[str]] = {}
    for mode in modes:
        place = (float(f"{mode.eigenvalue.real:.2g}"), float(f"{mode.frequency:.2g}"))
        places.setdefault(place, Counter())[f"{mode.laplacian_eigenvalue:.3g}"] += mode.count
    if len(places) > MOST_LABELS:
        return
    for place, counts in places.items():
        text = ", ".join(value if count == 1 else f"{value} (×{count})" for value, count in counts.items())
        # Slanted, labels of neighbours stay apart both in a row and in a column.
        axes.annotate(
            f"λ = {text}",
            place,
            (5, 5),
            textcoords="offset points",
            fontsize="small",
            rotation=30,
            rotation_mode="anchor",
            zorder=5,
        )
