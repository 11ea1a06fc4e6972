"""Run a scenario: aggregation, hand-off, transport, and the obstacle-free response."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from drake_formation.diagram import build_diagram
from drake_formation.parameters import set_parameters
from drake_formation.scenario import Scenario, derive
from drake_formation.simulation.engines import ENGINES, Engine
from drake_formation.simulation.recorder import NonFiniteStateError
from drake_formation.simulation.result import labelled_result

Progress = Callable[[float], None]
"""Called with how much simulated time is done, from 0 to :func:`simulated_duration` (s)."""


class SimulationError(RuntimeError):
    """A run that could not go on.

    Attributes:
        time: simulated time of the last good sample (s).
        robot: the robot that failed, from 1.
        partial: what was recorded until then, labelled as a result.
    """

    def __init__(self, message: str, time: float, robot: int, partial: xr.Dataset) -> None:
        super().__init__(message)
        self.time = time
        self.robot = robot
        self.partial = partial


def simulate(scenario: Scenario, *, engine: str = "blocks", progress: Progress | None = None) -> xr.Dataset:
    """Run a scenario from its initial state to its end.

    Where there are obstacles, the transport is run once more from the hand-off without them: the deviation from that
    response is the paper's tracking error.

    Args:
        scenario: what to run.
        engine: ``blocks``, the diagram on Drake's Simulator; or ``compiled``, code derived from the same diagram, for
            ``runge_kutta5`` only.
        progress: called as the simulated time goes on.

    Returns:
        The labelled result; see :func:`drake_formation.simulation.result.labelled_result`.

    Raises:
        ValueError: there is no such engine.
        ScenarioError: the scenario is wrong, or asks for an integrator that the compiled engine does not have.
        LoweringError: a block of the diagram cannot be compiled.
        SimulationError: the run diverged or the integrator gave up; it carries what was recorded.
    """
    if engine not in ENGINES:
        raise ValueError(f"no engine {engine!r}; there are {', '.join(ENGINES)}")
    diagram = build_diagram(scenario)
    start = ENGINES[engine](scenario, diagram)
    begin, hand_off, end = scenario.simulator.start_time, derive.hand_off_time(scenario), derive.end_time(scenario)

    run = start(diagram.CreateDefaultContext(), progress and (lambda time: progress(time - begin)))
    try:
        run.advance(hand_off)
        # Carry out the hand-off now, so that the first sample of the transport has its forces.
        run.carry_out_updates()
        at_hand_off = run.context.Clone()
        run.advance(end)
    except _FAILURES as failure:
        partial = labelled_result(scenario, run.recording, nominal=None)
        raise _simulation_error(scenario, run, partial, failure) from failure
    if not felt_obstacles(scenario):
        return labelled_result(scenario, run.recording, nominal=run.recording)
    _require_clear(labelled_result(scenario, run.recording, nominal=None))

    set_parameters(diagram, at_hand_off, without_obstacles(scenario))
    nominal = start(at_hand_off, progress and (lambda time: progress(end - begin + time - hand_off)))
    try:
        nominal.advance(end)
    except _FAILURES as failure:
        partial = labelled_result(scenario, run.recording, nominal.recording)
        raise _simulation_error(scenario, nominal, partial, failure) from failure
    return labelled_result(scenario, run.recording, nominal.recording)


def simulated_duration(scenario: Scenario) -> float:
    """How much time :func:`simulate` simulates in all (s)."""
    repeats = 2 if felt_obstacles(scenario) else 1
    return scenario.aggregation.duration + repeats * scenario.transport.duration


def felt_obstacles(scenario: Scenario) -> bool:
    """Whether any obstacle exerts a force."""
    return bool(scenario.avoidance.obstacles) and scenario.avoidance.gain > 0


def without_obstacles(scenario: Scenario) -> Scenario:
    """The scenario in which no obstacle exerts a force; its structure is the same."""
    return scenario.model_copy(update={"avoidance": scenario.avoidance.model_copy(update={"gain": 0.0})})


def _require_clear(result: xr.Dataset) -> None:
    """A robot inside an obstacle feels no force there: say so instead of carrying on as if nothing were in its way."""
    hit = (result["clearance"] <= 0) & (result["phase"] == 1)
    if not hit.any():
        return
    first = hit.isel(time=int(np.argmax(hit.any(["robot", "obstacle"]).values)))
    robot, obstacle = (int(index[0]) + 1 for index in np.nonzero(first.values))
    time = float(first["time"])
    raise SimulationError(
        f"robot {robot} is inside obstacle {obstacle} at t = {time:.6g} s. Try other starting positions, another "
        "place for the obstacle, or a larger avoidance.gain.",
        time,
        robot,
        result,
    )


# Drake's own complaints, and Python's from the laws: coincident robots divide by zero.
_FAILURES = (RuntimeError, ArithmeticError, SystemExit)


def _simulation_error(scenario: Scenario, run: Engine, partial: xr.Dataset, failure: BaseException) -> SimulationError:
    """Say when, which robot, why and what to try."""
    time = run.recording.times[-1] if len(run.recording.times) else run.context.get_time()
    robot = _culprit(run)
    reasons: dict[type[BaseException], str] = {
        NonFiniteStateError: "its state is no longer finite",
        ZeroDivisionError: "it met another robot or the middle of an obstacle",
        OverflowError: "its forces grew beyond all bounds",
    }
    reason = reasons.get(type(failure), f"the integrator gave up ({failure})")
    message = f"the run stopped at t = {time:.6g} s at robot {robot}: {reason}. Try {_advice(scenario, run)}."
    return SimulationError(message, float(time), robot, partial)


def _advice(scenario: Scenario, run: Engine) -> str:
    settings = scenario.simulator
    if run.fixed_step:
        return (
            f"a smaller simulator.max_step_size (now {settings.max_step_size:g} s), or error control: "
            "simulator.integration_scheme=runge_kutta5 with simulator.use_error_control=true"
        )
    return (
        f"a smaller simulator.accuracy (now {settings.accuracy:g}) or simulator.max_step_size (now "
        f"{settings.max_step_size:g} s), and look at the gains and the starting positions"
    )


def _culprit(run: Engine) -> int:
    """Of the robots whose state is not finite, or else of all, the one that was fastest at last; from 1."""
    state = run.context.get_continuous_state_vector().CopyToVector().reshape(-1, 4)
    lost = ~np.isfinite(state).all(axis=1)
    last = run.recording.series("state")[-1] if len(run.recording.times) else np.zeros_like(state)
    speed = np.abs(last[:, 2:]).max(axis=1)
    return int(np.argmax(np.where(lost | ~lost.any(), speed, -1.0))) + 1
