"""The compiled engine: the diagram lowered once, integrated piece by piece."""

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Context, Diagram

from drake_formation.config.errors import Fault, shown
from drake_formation.lowering import CompiledDiagram, Status, lower
from drake_formation.scenario import Scenario, ScenarioError, resolve
from drake_formation.simulation.engine import Start
from drake_formation.simulation.phases import Progress, felt_obstacles
from drake_formation.simulation.recorder import FARTHEST, BeyondBoundsError, NonFiniteStateError, RecordedPorts

Array = NDArray[np.float64]


def start(diagram: Diagram, method: str) -> Start:
    """Compile a diagram; the result starts runs of it.

    Args:
        diagram: a formation diagram.
        method: how to integrate; see :meth:`drake_formation.lowering.CompiledDiagram.integrate`.

    Raises:
        LoweringError: a block cannot be compiled.
    """
    lowered = lower(diagram)

    def run(scenario: Scenario, context: Context, progress: Progress | None) -> CompiledRun:
        require_compiled_settings(scenario, method)
        return CompiledRun(scenario, lowered, method, context, progress)

    return run


def require_compiled_settings(scenario: Scenario, method: str = "dormand_prince") -> None:
    """Refuse settings that compiled runs do not have.

    Args:
        scenario: what is to run.
        method: how it is integrated.

    Raises:
        ScenarioError: with what is allowed.
    """
    settings, faults = scenario.simulator, []
    if settings.integration_scheme != "runge_kutta5":
        scheme = shown(settings.integration_scheme)
        faults.append(Fault(("simulator", "integration_scheme"), "not compiled", scheme, "runge_kutta5"))
    if settings.target_realtime_rate:
        rate = shown(settings.target_realtime_rate)
        faults.append(Fault(("simulator", "target_realtime_rate"), "a compiled run keeps no clock", rate, "0"))
    formation = resolve(scenario)
    fields = formation.parts["avoidance"]
    jumps = any(getattr(field, "masked", False) and not field.margin for field in fields)
    switches = felt_obstacles(formation) and jumps
    if method == "exponential" and switches and formation.robots > 1:
        message = "the engine exponential cannot step over the jump in force where another robot becomes the nearest"
        allowed = "in_range, or the engine compiled or blocks, or an avoidance.margin above 0"
        faults.append(Fault(("avoidance", "sensing"), message, "nearest", allowed))
    if method == "exponential" and felt_obstacles(formation):
        for index, obstacle in enumerate(formation.obstacles):
            if not obstacle.is_convex:
                message = "the engine exponential cannot step over the jump in force between two edges of a notch"
                allowed = "the engine compiled or blocks, or convex polygons next to each other"
                faults.append(Fault(("avoidance", "obstacles", index), message, allowed=allowed))
    if faults:
        raise ScenarioError(faults)


class CompiledRun:
    """A run of a compiled diagram; its Context is brought up to date after every piece of the trajectory.

    Args:
        scenario: what runs.
        lowered: its diagram.
        method: how to integrate.
        context: where to start.
        progress: called with the simulated time (s) after every piece.
    """

    def __init__(
        self,
        scenario: Scenario,
        lowered: CompiledDiagram,
        method: str,
        context: Context,
        progress: Progress | None,
    ) -> None:
        settings = scenario.simulator
        self.context = context
        self.fixed_step = not settings.use_error_control
        self.recording = CompiledRecording(lowered, resolve(scenario).robots)
        self._lowered, self._method, self._progress = lowered, method, progress
        self._accuracy, self._max_step = settings.accuracy, settings.max_step_size
        self._updated_at = -np.inf

    def advance(self, end: float) -> None:
        """Go on to a time (s), updates due then not included.

        Raises:
            NonFiniteStateError: the state is not finite any more.
            BeyondBoundsError: error control cannot follow it any more.
            RuntimeError: the integrator gave up.
        """
        self.carry_out_updates()
        pieces = self._lowered.integrate(
            self.context,
            end,
            method=self._method,
            accuracy=self._accuracy,
            max_step=self._max_step,
            adaptive=not self.fixed_step,
            record=self.recording.names,
            updated=True,
            wired=True,
        )
        for piece in pieces:
            recorded = self._lowered.named(self.recording.names, piece.recorded)
            self.recording.add(piece.times, recorded)
            if self._progress:
                self._progress(self.context.get_time())
            if piece.status == Status.NOT_FINITE:
                raise NonFiniteStateError
            if piece.status == Status.STEP_TOO_SMALL:
                raise RuntimeError("its steps became too small to go on")
            states = [recorded[port] for port in self.recording.ports["state"]]
            if not self.fixed_step and np.abs(states).max(initial=0.0) > FARTHEST:
                raise BeyondBoundsError

    def carry_out_updates(self) -> None:
        """Carry out the updates due now unless that is done, and record what they change."""
        time = self.context.get_time()
        if time == self._updated_at:
            return
        self._updated_at = time
        self._lowered.updates.carry_out(self.context)
        state = self.context.get_continuous_state_vector().CopyToVector()
        values = self._lowered.read(self.context, wired=True)
        now = np.array([time])
        self.recording.add(now, self._lowered.outputs(self.recording.names, now, state[None], values))


class CompiledRecording(RecordedPorts):
    """What a compiled run leaves behind.

    Args:
        lowered: a compiled formation diagram.
        robots: number of robots N.

    Attributes:
        names: the diagram's output ports that it keeps.
    """

    def __init__(self, lowered: CompiledDiagram, robots: int) -> None:
        super().__init__(lowered.diagram, robots)
        self._lowered = lowered
        self._sizes = {name: lowered.diagram.GetOutputPort(ports[0]).size() for name, ports in self.ports.items()}
        self.names = ["phase", *(port for ports in self.ports.values() for port in ports)]
        self._times: list[Array] = []
        self._pieces: list[dict[str, Array]] = []
        self._known: dict[str, Array] = {}

    def add(self, times: Array, piece: dict[str, Array]) -> None:
        """Keep samples; one at the time of the last sample replaces it (the hand-off changes forces in no time)."""
        if not len(times):
            return
        if self._times and self._times[-1][-1] == times[0]:
            self._times[-1] = self._times[-1][:-1]
            self._pieces[-1] = {name: series[:-1] for name, series in self._pieces[-1].items()}
        self._times.append(times)
        self._pieces.append(piece)
        self._known.clear()

    @property
    def times(self) -> Array:
        """Sample times (s), shape (samples,)."""
        return np.concatenate([np.zeros(0), *self._times])

    @property
    def phases(self) -> Array:
        """0 during aggregation, 1 during transport; shape (samples,)."""
        return np.concatenate([np.zeros(0), *(piece["phase"][:, 0] for piece in self._pieces)])

    def series(self, port: str) -> Array:
        """Values of a recorded port, shape (samples, N, size)."""
        if port not in self._known:
            ports, size = self.ports[port], self._sizes[port]
            pieces = [np.stack([piece[name] for name in ports], axis=1) for piece in self._pieces]
            self._known[port] = np.concatenate([np.zeros((0, len(ports), size)), *pieces])
            self._known[port].setflags(write=False)
        return self._known[port]
