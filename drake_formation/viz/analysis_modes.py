"""Figures of the closed loop's eigenvalues: the map of modes, and where they go as δ grows."""

from collections import Counter
from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.linear.motion_subspaces import PARTS
from drake_formation.analysis.stability.modes import Mode, Modes, decay_limit

STYLES = {
    "centre": ("o", "tab:blue"),
    "rotation": ("D", "tab:orange"),
    "stretch": ("^", "tab:green"),
    "consensus": ("s", "tab:purple"),
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


def mode_map(modes: Modes, title: str) -> Figure:
    """Every mode in the complex plane by kind, with its Laplacian eigenvalue; conjugates are left out.

    Args:
        modes: from :func:`drake_formation.analysis.stability.modes`.
        title: name of the scenario.
    """
    figure, axes = _plane([mode.eigenvalue for mode in modes.modes], f"{title}: modes")
    for kind in PARTS:
        _draw_kind(axes, kind, [mode for mode in modes.modes if mode.kind == kind])
    _label(axes, modes.modes)
    axes.plot([], [], "o", color="0.4", fillstyle="none", label="open: consensus cannot move it")
    _legend(figure, axes)
    return figure


def root_locus(formation: LinearFormation) -> Figure:
    """Where all eigenvalues go as δ grows from 0, at the scenario's δ_v; rings mark the scenario's own δ."""
    largest = max(LARGEST_DELTA, 2 * formation.delta)
    deltas = np.concatenate([[0.0], np.geomspace(1e-5 * largest, largest, VALUES)])
    loci = np.array([np.linalg.eigvals(formation.closed_loop(delta, formation.delta_v)) for delta in deltas])
    figure, axes = _plane(loci.ravel(), f"{formation.scenario.name}: root locus, δ_v = {formation.delta_v:g} N s/m")
    upper = loci.imag >= -1e-9
    shown = np.broadcast_to(np.maximum(deltas, deltas[1])[:, None], loci.shape)[upper]
    dots = axes.scatter(
        loci.real[upper], loci.imag[upper], c=shown, s=9, cmap="viridis", norm=LogNorm(deltas[1], largest), zorder=3
    )
    figure.colorbar(dots, ax=axes, label="δ (N/m)")
    own = np.linalg.eigvals(formation.A)
    own = own[own.imag >= -1e-9]
    label = f"the scenario's δ = {formation.delta:g} N/m"
    axes.plot(own.real, own.imag, "o", color="black", fillstyle="none", markersize=9, label=label, zorder=4)
    limit = decay_limit(formation)
    if limit is not None:
        text = f"mean decay rate of what consensus moves, for every δ: {limit:.4g} 1/s"
        axes.axvline(-limit, color="tab:red", linestyle="--", linewidth=1, label=text)
    _legend(figure, axes)
    return figure


def _plane(values: Iterable[complex], title: str) -> tuple[Figure, Axes]:
    """The upper half of the complex plane about some eigenvalues; frequencies on a scale that reaches 0."""
    points = np.array(list(values))
    figure = Figure(figsize=(8.5, 5.5), layout="constrained")
    axes = figure.subplots()
    fastest = float(np.abs(points.imag).max())
    left, right = float(points.real.min()), float(points.real.max())
    reach = max(abs(left), abs(right))
    axes.set_xlim(min(left, 0.0) - 0.35 * reach, max(right, 0.0) + 0.2 * reach)
    axes.set_yscale("symlog", linthresh=_smallest_frequency(points), linscale=0.5)
    axes.set_ylim(-0.3 * _smallest_frequency(points), 3 * max(fastest, _smallest_frequency(points)))
    axes.axvspan(0, axes.get_xlim()[1], color="tab:red", alpha=0.08, linewidth=0, label="unstable")
    axes.axvline(0, color="0.3", linewidth=0.8)
    _draw_damping(axes)
    axes.set(xlabel="Re s (1/s): minus the decay rate", ylabel="Im s (rad/s): frequency", title=title)
    axes.grid(alpha=0.3)
    return figure, axes


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
            markersize=8,
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


def _legend(figure: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize="small", frameon=False)
