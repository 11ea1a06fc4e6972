"""Runs of variants of a scenario: one diagram, made ready once, runs all that are of its structure."""

import time

from drake_formation.parameters import structure
from drake_formation.scenario import Scenario, resolve
from drake_formation.simulation import PreparedRun
from drake_formation.simulation.series import Series

PATIENCE = 5.0
"""How long a run may take (s), unless it is the first of its structure, for which code is compiled."""


class PatienceError(Exception):
    """A run that took too long, as those do that ring or diverge ever faster."""


class Runs:
    """Runs scenarios, by compiled code where they can be compiled, and keeps the diagrams for the next ones."""

    def __init__(self) -> None:
        self._prepared: list[PreparedRun] = []

    def run(self, scenario: Scenario) -> Series:
        """Run a scenario.

        Raises:
            ScenarioError, SimulationError: it is wrong, or its run failed.
            PatienceError: its run took too long.
        """
        known = len(self._prepared)
        prepared = self._made_ready(scenario)
        if len(self._prepared) > known:
            return prepared.run_known(scenario)
        end = time.monotonic() + PATIENCE

        def hurry(reached: float) -> None:
            if time.monotonic() > end:
                raise PatienceError(f"given up at {reached:.4g} s of the run, as it takes longer than {PATIENCE:g} s")

        return prepared.run_known(scenario, progress=hurry)

    def _made_ready(self, scenario: Scenario) -> PreparedRun:
        wanted = structure(resolve(scenario))
        for prepared in self._prepared:
            if prepared.structure == wanted:
                return prepared
        self._prepared.append(PreparedRun.compiled(scenario))
        return self._prepared[-1]
