"""Results and figures of the study's runs, kept on disk so that no run is made twice."""

import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path
from typing import Protocol

import xarray as xr

from drake_formation.lowering.errors import LoweringError
from drake_formation.measuring import Metrics
from drake_formation.paper.measured import measured
from drake_formation.scenario import Scenario, ScenarioError, resolve
from drake_formation.simulation import SimulationError, simulate
from drake_formation.sweep.errors import SweepStoppedError
from drake_formation.sweep.processes import Processes, WorkerDiedError
from drake_formation.sweep.work import versions

# Drake 1.51 leaks Python systems; workers are replaced before that matters.
RUNS_PER_WORKER = 128

RESULT, FIGURES = ".nc", ".json"
"""Kinds of files, by their suffixes: a run's labelled result, and what is measured of it."""


class Measures(Protocol):
    """What has the figures of runs."""

    def measured(self, scenario: Scenario) -> Metrics:
        """The figures of a scenario's run."""


class Store:
    """Runs by scenario, in a folder.

    A run is found again by its resolved scenario, the engine, and the software that made it, down to the code of this
    package: other code makes the runs anew, beside the earlier ones, and a report never mixes them.

    Args:
        folder: where; made if missing.
        engine: how to run, as for :func:`drake_formation.simulate`.
    """

    def __init__(self, folder: Path, engine: str = "compiled") -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder
        self._engine = engine

    def __getitem__(self, scenario: Scenario) -> xr.Dataset:
        """The result of a scenario, run now if it has not been, or if its file is damaged.

        Raises:
            SweepStoppedError: it cannot be made, or not kept.
        """
        path = self.path(scenario)
        if path.exists():
            try:
                return xr.load_dataset(path, engine="netcdf4")
            except (OSError, RuntimeError, ValueError, KeyError, IndexError):
                pass
        if problem := attempt(scenario, path, self._engine):
            raise SweepStoppedError(f"{path}: {problem}")
        return xr.load_dataset(path, engine="netcdf4")

    def measured(self, scenario: Scenario) -> Metrics:
        """The figures of a scenario's run, which is made now if it has not been, or if their file is damaged.

        Raises:
            SweepStoppedError: it cannot be made, or not kept.
        """
        path = self.path(scenario, FIGURES)
        try:
            return _read_figures(path)
        except (OSError, ValueError):
            pass
        if problem := attempt(scenario, path, self._engine):
            raise SweepStoppedError(f"{path}: {problem}")
        return _read_figures(path)

    def path(self, scenario: Scenario, kind: str = RESULT) -> Path:
        """File of a scenario's result, or of its figures."""
        # Not YAML: of the thousands of keys of a report it would take a minute.
        text = "\n".join([repr(scenario.model_dump()), json.dumps(versions()), self._engine])
        return self._folder / f"{scenario.name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}{kind}"

    def missing(self, scenarios: Iterable[Scenario], figures: Iterable[Scenario] = ()) -> dict[Path, Scenario]:
        """Files that are not there, by the scenario to run for each, the longest first.

        Args:
            scenarios: whose results are needed; their figures come along.
            figures: whose figures alone are needed.
        """
        results = {self.path(scenario): scenario for scenario in scenarios}
        brought = {path.with_suffix(FIGURES) for path in results}
        measured = {self.path(scenario, FIGURES): scenario for scenario in figures}
        wanted = results | {path: scenario for path, scenario in measured.items() if path not in brought}
        missing = ((path, scenario) for path, scenario in wanted.items() if not path.exists())
        return dict(sorted(missing, key=lambda item: _effort(item[1]), reverse=True))

    def run(self, missing: Mapping[Path, Scenario], done: Callable[[], None]) -> None:
        """Run what is missing, on all processors.

        Args:
            missing: as :meth:`missing` gives it.
            done: called after each run.

        Raises:
            SweepStoppedError: a run cannot be made, or not kept; those that were finished are.
        """
        workers = os.cpu_count() or 1
        files = list(missing.items())
        for first in range(0, len(files), workers * RUNS_PER_WORKER):
            batch = files[first : first + workers * RUNS_PER_WORKER]
            with Processes(min(len(batch), workers)) as pool:
                self._run_batch(batch, pool, done)

    def _run_batch(self, batch: Iterable[tuple[Path, Scenario]], pool: Processes, done: Callable[[], None]) -> None:
        def begin(path: Path, scenario: Scenario) -> "Future[str | None]":
            return pool.call(attempt, scenario, path, self._engine)

        waiting = {begin(path, scenario): (path, scenario) for path, scenario in batch}
        retried: set[Path] = set()
        while waiting:
            for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                path, scenario = waiting.pop(future)
                try:
                    problem = future.result()
                except WorkerDiedError as death:
                    if path not in retried:
                        retried.add(path)
                        waiting[begin(path, scenario)] = path, scenario
                        continue
                    problem = str(death)
                if problem:
                    raise SweepStoppedError(f"{path}: {problem}")
                done()


def attempt(scenario: Scenario, path: Path, engine: str) -> str | None:
    """Run a scenario to a file; gives why that cannot be, as not every error can be sent from a worker."""
    try:
        run_to_file(scenario, path, engine)
    except (SimulationError, ScenarioError, LoweringError, OSError) as error:
        return str(error)
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return None


def run_to_file(scenario: Scenario, path: Path, engine: str) -> None:
    """Run a scenario; the files of its figures and, if the path is a result's, of the result appear when complete."""
    result = simulate(scenario, engine=engine)
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        partial = Path(folder) / path.name
        figures = partial.with_suffix(FIGURES)
        figures.write_text(json.dumps(measured(scenario, result).to_dict()), encoding="utf-8")
        figures.replace(path.with_suffix(FIGURES))
        if path.suffix == RESULT:
            result.to_netcdf(partial, engine="netcdf4")
            partial.replace(path)


def _read_figures(path: Path) -> Metrics:
    """Figures from their file.

    Raises:
        OSError: there is none.
        ValueError: it is damaged.
    """
    figures = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(figures, dict):
        raise ValueError(f"{path} holds no figures")  # noqa: TRY004 - a damaged file, as one that is no JSON
    return Metrics(**figures)


def _effort(scenario: Scenario) -> float:
    """Grows with how long a run takes: with the robots, and with the fastest mode of real and virtual springs."""
    formation = resolve(scenario)
    robots = formation.robots
    delta = formation.field("coordination", "delta").max()
    stiffest = float(formation.field("spring", "stiffness").max(initial=0.0) + 2 * delta)
    return float(robots**2 * (1 + robots * stiffest) ** 0.5)
