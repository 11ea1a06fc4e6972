"""One run of a sweep, from a scenario to its numbers."""

from collections import OrderedDict

import numpy as np
from numpy.typing import NDArray

from drake_formation.measuring import measure
from drake_formation.parameters import structure
from drake_formation.scenario import Scenario, ScenarioError, resolve
from drake_formation.simulation import PreparedRun
from drake_formation.sweep.limits import series_faults
from drake_formation.sweep.sampling import sample
from drake_formation.sweep.schema import Trajectories

Array = NDArray[np.float64]

STRUCTURES = 32
"""Diagrams kept ready; a sweep over more structures than this builds them anew when they come again."""


class Runner:
    """Runs scenarios and keeps what a sweep asks for; builds a diagram once for each structure.

    Args:
        engine: as for :func:`drake_formation.simulate`.
        trajectories: time series to keep beside the metrics.

    Attributes:
        built: diagrams built until now.
    """

    def __init__(self, engine: str, trajectories: Trajectories | None) -> None:
        self.built = 0
        self._engine = engine
        self._trajectories = trajectories
        self._prepared: OrderedDict[str, PreparedRun] = OrderedDict()

    def measure(self, scenario: Scenario) -> dict[str, Array]:
        """Metrics of a scenario, NaN where there is nothing to measure, and samples of the time series.

        Raises:
            SimulationError: the run diverged or the integrator gave up.
            ScenarioError, LoweringError: the engine cannot run this scenario, or its time series are too long.
        """
        if faults := list(series_faults(self._trajectories, scenario, points=1)):
            raise ScenarioError(faults)
        series = self._ready(scenario).run_known(scenario)
        values = {
            name: np.array(np.nan if value is None else value, dtype=float)
            for name, value in measure(series).to_dict().items()
        }
        if self._trajectories:
            values |= sample(series, self._trajectories.variables, self._trajectories.every)
        return values

    def _ready(self, scenario: Scenario) -> PreparedRun:
        key = repr(structure(resolve(scenario)))
        if key not in self._prepared:
            self.built += 1
            self._prepared[key] = PreparedRun(scenario, engine=self._engine)
            if len(self._prepared) > STRUCTURES:
                self._prepared.popitem(last=False)
        self._prepared.move_to_end(key)
        return self._prepared[key]
