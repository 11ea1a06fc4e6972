"""What carries a run forward in time: Drake's Simulator, or the diagram compiled."""

import math
from collections.abc import Callable

from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig
from pydrake.systems.framework import Context, Diagram

from drake_formation.scenario import Scenario, resolve
from drake_formation.simulation.engine import Start
from drake_formation.simulation.phases import Progress
from drake_formation.simulation.recorder import FARTHEST, Recorder


def blocks(diagram: Diagram) -> Start:
    """The diagram itself, on Drake's Simulator."""
    return lambda scenario, context, progress: _Blocks(scenario, diagram, context, progress)


def compiled(diagram: Diagram) -> Start:
    """The diagram compiled; see :mod:`drake_formation.lowering`. It starts scenarios with ``runge_kutta5`` only.

    Raises:
        LoweringError: a block cannot be compiled.
    """
    from drake_formation.simulation.compiled import start  # building diagrams need not pay for the compiler

    return start(diagram, "dormand_prince")


def exponential(diagram: Diagram) -> Start:
    """The diagram compiled, its linear part integrated exactly; in place of ``runge_kutta5``.

    Its steps may be longer than the oscillations of stiff springs, where those have died away; as long as they ring,
    steps are so short that what is read between samples is near the motion. It starts no scenario whose obstacles only
    the nearest robot senses: there the force jumps.

    Raises:
        LoweringError: a block cannot be compiled.
    """
    from drake_formation.simulation.compiled import start

    return start(diagram, "exponential")


ENGINES: dict[str, Callable[[Diagram], Start]] = {
    "blocks": blocks,
    "compiled": compiled,
    "exponential": exponential,
}


class _Blocks:
    def __init__(self, scenario: Scenario, diagram: Diagram, context: Context, progress: Progress | None) -> None:
        self._simulator = Simulator(diagram, context)
        config = SimulatorConfig(**scenario.simulator.model_dump())
        config.start_time = context.get_time()  # Drake's would overwrite it, and it may be at the hand-off
        ApplySimulatorConfig(config, self._simulator)
        farthest = math.inf if self.fixed_step else FARTHEST
        self.recording = Recorder(diagram, resolve(scenario).robots, progress, farthest)
        self._simulator.set_monitor(self.recording)
        self._started = False

    @property
    def context(self) -> Context:
        return self._simulator.get_context()

    @property
    def fixed_step(self) -> bool:
        return bool(self._simulator.get_integrator().get_fixed_step_mode())

    def advance(self, end: float) -> None:
        self._start()
        self._simulator.AdvanceTo(end)

    def carry_out_updates(self) -> None:
        self._start()
        self._simulator.AdvancePendingEvents()
        self.recording(self.context)

    def _start(self) -> None:
        if not self._started:
            self._simulator.Initialize()
            self._started = True
