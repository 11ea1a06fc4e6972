"""Results of the study's runs, kept on disk so that no run is made twice."""

import hashlib
import multiprocessing
import os
import tempfile
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib.metadata import version
from pathlib import Path

import xarray as xr

from drake_formation.scenario import Scenario, resolve, to_yaml
from drake_formation.simulation import simulate

# Drake 1.51 leaks Python systems; workers are replaced before that matters.
RUNS_PER_WORKER = 32


class Store:
    """Runs by scenario, in a folder.

    A run is found again by its resolved scenario, the engine, and the versions of this package and of Drake.

    Args:
        folder: where; made if missing.
        engine: how to run, as for :func:`drake_formation.simulate`.
    """

    def __init__(self, folder: Path, engine: str = "compiled") -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder
        self._engine = engine

    def __getitem__(self, scenario: Scenario) -> xr.Dataset:
        """The result of a scenario, run now if it has not been."""
        path = self.path(scenario)
        if not path.exists():
            run_to_file(scenario, path, self._engine)
        return xr.load_dataset(path)

    def path(self, scenario: Scenario) -> Path:
        """File of a scenario's result."""
        text = "\n".join([to_yaml(scenario), version("drake-formation"), version("drake"), self._engine])
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
        """
        missing = self.missing(scenarios)
        workers = os.cpu_count() or 1
        # A new pool for every batch: the executor's own max_tasks_per_child deadlocks on some Pythons (gh-115634).
        for first in range(0, len(missing), workers * RUNS_PER_WORKER):
            batch = missing[first : first + workers * RUNS_PER_WORKER]
            context = multiprocessing.get_context("spawn")
            with ProcessPoolExecutor(min(len(batch), workers), mp_context=context) as pool:
                runs = [pool.submit(run_to_file, scenario, self.path(scenario), self._engine) for scenario in batch]
                for run in as_completed(runs):
                    run.result()
                    done()


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
