"""Running a sweep: what is missing is run and kept, then all of it becomes one dataset."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from drake_formation.simulation.engines import ENGINES
from drake_formation.sweep.channel_labels import channel_labels
from drake_formation.sweep.dataset import FAILURES, write_dataset, write_failures
from drake_formation.sweep.definition import Sweep
from drake_formation.sweep.drive import drive
from drake_formation.sweep.errors import SweepError, SweepStoppedError
from drake_formation.sweep.executors import Executor, choose
from drake_formation.sweep.load import load_sweep
from drake_formation.sweep.store import Store
from drake_formation.sweep.work import Outcome, Task, versions

DATASET, FIGURES = "sweep.nc", "figures"
MISSING = "missing_figures"
"""Attribute of the dataset that names figures which could not be drawn, and why; not part of the file."""


@dataclass(frozen=True)
class Tally:
    """How far a sweep is.

    Attributes:
        total: number of points.
        finished: points that are on disk, failed ones included.
        failed: points whose run failed.
        resumed: points that were on disk before this call.
    """

    total: int
    finished: int
    failed: int
    resumed: int


Progress = Callable[[Tally], None]
"""Called before the first run, and whenever further runs are on disk."""


def run_sweep(
    sweep: Sweep | str | Path | Mapping[str, Any],
    out: str | Path,
    *,
    engine: str = "compiled",
    executor: str | Executor = "processes",
    workers: int | None = None,
    scheduler: str | None = None,
    retry_failed: bool = False,
    figures: bool = True,
    file_format: str = "png",
    progress: Progress | None = None,
) -> xr.Dataset:
    """Run a sweep, or what is missing of it.

    Every finished run is on disk, in ``runs.sqlite``, before it counts: a sweep that was interrupted, even killed,
    goes on where it was when it is called again. Results depend neither on the executor nor on its workers. Runs made
    by other software, be it other code of this package in the same version, are never mixed: a folder that holds such
    runs is refused, and a worker that has other code too.

    Args:
        sweep: a sweep, or what :func:`load_sweep` takes.
        out: folder for the runs, ``sweep.nc`` and ``figures``.
        engine: as for :func:`drake_formation.simulate`.
        executor: ``processes`` on this machine, or ``serial``: this process; or an executor that is open already, such
            as a :class:`drake_formation.sweep.Processes` that serves several sweeps, which then stays open.
        workers: number of processes; as many as processors if not given.
        scheduler: address of a Dask scheduler, whose workers then run the sweep.
        retry_failed: run again what failed before.
        figures: whether to draw figures, where one or two axes are swept.
        file_format: of the figures, png, pdf or svg.
        progress: called as runs finish.

    Returns:
        The dataset of ``sweep.nc``, opened but not read; see :func:`drake_formation.sweep.dataset.write_dataset`.

    Raises:
        ScenarioError: the sweep is wrong.
        SweepError: it cannot be begun so, or there.
        SweepStoppedError: it cannot go on, or what it made cannot be written; what was finished is kept.
    """
    if not isinstance(sweep, Sweep):
        sweep = load_sweep(sweep)
    if engine not in ENGINES:
        raise SweepError(f"no engine {engine!r}; there are {', '.join(ENGINES)}")
    workforce = choose(executor, workers, scheduler) if isinstance(executor, str) else nullcontext(executor)
    folder = Path(out)
    identity = {"sweep": sweep.fingerprint(), "engine": engine} | versions()
    with Store(folder, identity) as store:
        finished, failed = store.kept(len(sweep))
        missing = np.flatnonzero(~finished | failed if retry_failed else ~finished)
        resumed = len(sweep) - len(missing)

        def keep(outcomes: Sequence[Outcome]) -> None:
            store.add(outcomes)
            for outcome in outcomes:
                finished[outcome.index], failed[outcome.index] = True, outcome.error is not None
            tell()

        def tell() -> None:
            if progress:
                progress(Tally(len(sweep), int(finished.sum()), int(failed.sum()), resumed))

        if retry_failed:
            finished &= ~failed
            failed[:] = False
        tell()
        if len(missing):
            task = Task(sweep.base.data, engine, sweep.trajectories, versions())
            with workforce as workers_at_hand:
                drive(sweep, task, missing, workers_at_hand, keep)
        with _explained(folder / DATASET):
            write_dataset(folder / DATASET, sweep, store, identity)
        with _explained(folder / FAILURES):
            write_failures(folder, sweep, store)
        dataset = xr.open_dataset(folder / DATASET, engine="netcdf4")
        if figures:
            from drake_formation.viz.sweep_figures import write_sweep_figures

            labels = channel_labels(sweep)
            with _explained(folder / FIGURES):
                failures = write_sweep_figures(dataset, folder / FIGURES, labels, file_format)
            if failures:
                dataset.attrs[MISSING] = "\n".join(f"No figure {name}: {reason}" for name, reason in failures.items())
    return dataset


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    """What the system, or a library of files, says against a file that is made of the runs."""
    try:
        yield
    except SweepError:
        raise
    except (OSError, RuntimeError) as error:
        reason = (isinstance(error, OSError) and error.strerror) or str(error)
        raise SweepStoppedError(f"{path}: cannot be written: {reason}") from error
