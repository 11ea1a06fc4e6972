"""One run of a sweep, from a scenario to its numbers."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.metrics import metrics
from drake_formation.scenario import Scenario
from drake_formation.simulation import simulate
from drake_formation.sweep.sampling import sample
from drake_formation.sweep.schema import Trajectories

Array = NDArray[np.float64]


class Runner:
    """Runs scenarios and keeps what a sweep asks for.

    Args:
        engine: ``blocks`` or ``compiled``.
        trajectories: time series to keep beside the metrics.
    """

    def __init__(self, engine: str, trajectories: Trajectories | None) -> None:
        self.built = 0
        self._engine = engine
        self._trajectories = trajectories

    def measure(self, scenario: Scenario) -> dict[str, Array]:
        """Metrics of a scenario, NaN where there is nothing to measure, and samples of the time series.

        Raises:
            SimulationError: the run diverged or the integrator gave up.
            ScenarioError, LoweringError: the engine cannot run this scenario.
        """
        self.built += 1
        result = simulate(scenario, engine=self._engine)
        values = {
            name: np.array(np.nan if value is None else value, dtype=float)
            for name, value in metrics(result).to_dict().items()
        }
        if self._trajectories:
            values |= sample(result, self._trajectories.variables, self._trajectories.every)
        return values
