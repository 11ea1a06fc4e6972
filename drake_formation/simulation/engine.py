"""What an engine is: a run from a Context's time and state, whatever carries it forward."""

from collections.abc import Callable
from typing import Protocol

from pydrake.systems.framework import Context

from drake_formation.scenario import Scenario
from drake_formation.simulation.phases import Progress
from drake_formation.simulation.recorder import Recording


class Engine(Protocol):
    """A run from a Context's time and state, which go along."""

    @property
    def context(self) -> Context:
        """Where the run is."""

    @property
    def recording(self) -> Recording:
        """What was recorded until now."""

    @property
    def fixed_step(self) -> bool:
        """Whether every step is the largest, for want of error control."""

    def advance(self, end: float) -> None:
        """Go on to a time (s), updates due then not included.

        Raises:
            RuntimeError, ArithmeticError, SystemExit: the run cannot go on.
        """

    def carry_out_updates(self) -> None:
        """Carry out the updates due now, and record what that changes."""


Start = Callable[[Scenario, Context, Progress | None], Engine]
"""Makes an engine that runs a scenario from a Context; called with the simulated time after every step."""
