"""Results of the study's runs, kept on disk so that no run is made twice."""

import hashlib
import json
import os
import tempfile
from collections.abc import Callable, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from pathlib import Path

import xarray as xr

from drake_formation.lowering.errors import LoweringError
from drake_formation.scenario import Scenario, ScenarioError, resolve, to_yaml
from drake_formation.simulation import SimulationError, simulate
from drake_formation.sweep.errors import SweepStoppedError
from drake_formation.sweep.processes import Processes, WorkerDiedError
from drake_formation.sweep.work import versions

# Drake 1.51 leaks Python systems; workers are replaced before that matters.
RUNS_PER_WORKER = 32


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

    def path(self, scenario: Scenario) -> Path:
        """File of a scenario's result."""
        text = "\n".join([to_yaml(scenario), json.dumps(versions()), self._engine])
        return self._folder / f"{scenario.name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}.nc"

    def missing(self, scenarios: Iterable[Scenario]) -> list[Scenario]:
        """Those that have not been run, once each, the longest first."""
        wanted = {self.path(scenario): scenario for scenario in scenarios}
        return sorted((s for path, s in wanted.items() if not path.exists()), key=_effort, reverse=True)

    def run(self, scenarios: Iterable[Scenario], done: Callable[[], None]) -> None:
        """Run what is missing, on all processors.

        Args:
            scenarios: what is needed.
            done: called after each run.

        Raises:
            SweepStoppedError: a run cannot be made, or not kept; those that were finished are.
        """
        missing = self.missing(scenarios)
        workers = os.cpu_count() or 1
        for first in range(0, len(missing), workers * RUNS_PER_WORKER):
            batch = missing[first : first + workers * RUNS_PER_WORKER]
            with Processes(min(len(batch), workers)) as pool:
                self._run_batch(batch, pool, done)

    def _run_batch(self, batch: Iterable[Scenario], pool: Processes, done: Callable[[], None]) -> None:
        def begin(scenario: Scenario) -> "Future[str | None]":
            return pool.call(attempt, scenario, self.path(scenario), self._engine)

        waiting = {begin(scenario): scenario for scenario in batch}
        retried: set[Path] = set()
        while waiting:
            for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                scenario = waiting.pop(future)
                path = self.path(scenario)
                try:
                    problem = future.result()
                except WorkerDiedError as death:
                    if path not in retried:
                        retried.add(path)
                        waiting[begin(scenario)] = scenario
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
    """Run a scenario; the file appears when it is complete."""
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        partial = Path(folder) / path.name
        simulate(scenario, engine=engine).to_netcdf(partial, engine="netcdf4")
        partial.replace(path)


def _effort(scenario: Scenario) -> float:
    """Grows with how long a run takes: with the robots, and with the fastest mode of real and virtual springs."""
    formation = resolve(scenario)
    robots = formation.robots
    delta = formation.field("coordination", "delta").max()
    stiffest = float(formation.field("spring", "stiffness").max(initial=0.0) + 2 * delta)
    return float(robots**2 * (1 + robots * stiffest) ** 0.5)
