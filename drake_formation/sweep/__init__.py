"""Sweeps: a scenario run over grids, lists and random samples of its fields, into one labelled dataset.

Run a shipped sweep on all processors::

    from drake_formation.sweep import run_sweep

    results = run_sweep("gains", "out/gains")  # an xarray Dataset over the axes
    results["peak_force_n"].sel(stiffness=3e4)
"""

from drake_formation.sweep.definition import Sweep
from drake_formation.sweep.errors import SweepError, SweepStoppedError
from drake_formation.sweep.load import load_sweep, shipped_sweeps
from drake_formation.sweep.processes import Processes
from drake_formation.sweep.run import Tally, run_sweep

__all__ = [
    "Processes",
    "Sweep",
    "SweepError",
    "SweepStoppedError",
    "Tally",
    "load_sweep",
    "run_sweep",
    "shipped_sweeps",
]
