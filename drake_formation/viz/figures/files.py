"""The figures of a run, each in a file."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import xarray as xr

from drake_formation.viz.figures.histories import consensus_error, control_forces, spring_lengths, tracking_error
from drake_formation.viz.figures.overview import overview
from drake_formation.viz.figures.plane import paths
from drake_formation.viz.style import Drawn, draw_each

FIGURES: dict[str, Callable[[xr.Dataset], Drawn]] = {
    "overview": overview,
    "paths": paths,
    "tracking_error": tracking_error,
    "consensus_error": consensus_error,
    "spring_lengths": spring_lengths,
    "control_forces": control_forces,
}
"""Every figure of a run, by the name of its file."""


def write_figures(result: xr.Dataset, folder: Path, file_format: str = "png") -> dict[str, str]:
    """Draw every figure of a run as a file in a folder that exists; gives those that failed, and why."""
    return draw_each({name: partial(draw, result) for name, draw in FIGURES.items()}, folder, file_format)
