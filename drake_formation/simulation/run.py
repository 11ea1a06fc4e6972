"""Run a scenario: aggregation, hand-off, transport, and the obstacle-free response."""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from pydrake.systems.framework import Context

from drake_formation.diagram import build_diagram
from drake_formation.formation.formation import Formation
from drake_formation.parameters import block_parameters, structure, write_parameters, write_start
from drake_formation.scenario import Scenario, resolve
from drake_formation.simulation.engines import ENGINES, Engine
from drake_formation.simulation.obstacles import Leap, first_hit, worst_leap
from drake_formation.simulation.recorder import NonFiniteStateError, Recording
from drake_formation.simulation.result import labelled_result
from drake_formation.simulation.series import Series, time_series

if TYPE_CHECKING:
    import xarray as xr

MOST_STEPS = 200_000
"""A run that would need more of them, as its obstacles are so small, is refused."""

Progress = Callable[[float], None]
"""Called with how much simulated time is done, from 0 to :func:`simulated_duration` (s)."""


class SimulationError(RuntimeError):
    """A run that could not go on.

    Attributes:
        time: simulated time of the last good sample (s).
        robot: the robot that failed, from 1.
        partial: what was recorded until then, labelled as a result.
    """

    def __init__(self, message: str, time: float, robot: int, partial: "xr.Dataset") -> None:
        super().__init__(message)
        self.time = time
        self.robot = robot
        self.partial = partial


def simulate(scenario: Scenario, *, engine: str = "blocks", progress: Progress | None = None) -> "xr.Dataset":
    """Run a scenario from its initial state to its end.

    Where there are obstacles, the transport is run once more from the hand-off without them: the deviation from that
    response is the paper's tracking error. Where a robot crossed much of an obstacle's range in one step, the whole is
    repeated with shorter steps.

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
    return labelled_result(scenario, PreparedRun(scenario, engine=engine).run(scenario, progress=progress))


class PreparedRun:
    """A diagram, built and made ready once, that runs every scenario of its structure.

    A run depends on its scenario alone, not on what ran before.

    Args:
        scenario: gives the structure; see :func:`drake_formation.parameters.structure`.
        engine: as for :func:`simulate`.

    Raises:
        ValueError, ScenarioError, LoweringError: as for :func:`simulate`.
    """

    def __init__(self, scenario: Scenario, *, engine: str = "blocks") -> None:
        if engine not in ENGINES:
            raise ValueError(f"no engine {engine!r}; there are {', '.join(ENGINES)}")
        self.diagram = build_diagram(scenario)
        self.structure = structure(resolve(scenario))
        self._start = ENGINES[engine](self.diagram)
        self._context = self.diagram.CreateDefaultContext()

    def run(self, scenario: Scenario, *, progress: Progress | None = None) -> Series:
        """Run a scenario of the same structure.

        Args:
            scenario: what to run.
            progress: called as the simulated time goes on.

        Returns:
            The variables of the labelled result as plain arrays, which :func:`drake_formation.metrics.measure` takes.

        Raises:
            ScenarioError, SimulationError: as for :func:`simulate`.
            ValueError: its structure differs.
        """
        if structure(resolve(scenario)) != self.structure:
            raise ValueError(f"scenario {scenario.name!r} has another structure than the diagram made ready")
        return self.run_known(scenario, progress=progress)

    def run_known(self, scenario: Scenario, *, progress: Progress | None = None) -> Series:
        """Run a scenario that is known to have the structure.

        Args:
            scenario: what to run.
            progress: called as the simulated time goes on.

        Returns:
            As :meth:`run`.

        Raises:
            ScenarioError, SimulationError: as for :func:`simulate`.
        """
        formation = resolve(scenario)
        begin, hand_off, end = formation.begin, formation.hand_off, formation.end
        context = self._initial_context(formation)
        run = self._start(scenario, context, progress and (lambda time: progress(time - begin)))
        try:
            run.advance(hand_off)
            # Carry out the hand-off now, so that the first sample of the transport has its forces.
            run.carry_out_updates()
            at_hand_off = run.context.Clone() if felt_obstacles(scenario) else None
            run.advance(end)
        except _FAILURES as failure:
            if felt_obstacles(scenario) and len(run.recording.times):
                _require_clear(scenario, run)
                if leap := worst_leap(scenario, run.recording):
                    return self.run_known(_with_shorter_steps(scenario, run, leap), progress=progress)
            raise _simulation_error(scenario, run, run.recording, None, failure) from failure
        if at_hand_off is None:
            return time_series(scenario, run.recording, run.recording)
        _require_clear(scenario, run)
        if leap := worst_leap(scenario, run.recording):
            return self.run_known(_with_shorter_steps(scenario, run, leap), progress=progress)

        write_parameters(self.diagram, at_hand_off, block_parameters(resolve(without_obstacles(scenario))))
        nominal = self._start(
            scenario, at_hand_off, progress and (lambda time: progress(end - begin + time - hand_off))
        )
        try:
            nominal.advance(end)
        except _FAILURES as failure:
            raise _simulation_error(scenario, nominal, run.recording, nominal.recording, failure) from failure
        return time_series(scenario, run.recording, nominal.recording)

    def _initial_context(self, formation: Formation) -> Context:
        context = self._context  # one for all runs, as making one takes as long as some runs
        context.SetTime(0.0)
        self.diagram.SetDefaultContext(context)
        write_parameters(self.diagram, context, block_parameters(formation))
        write_start(self.diagram, context, formation)
        return context


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


def _require_clear(scenario: Scenario, run: Engine) -> None:
    """Refuse a run with a robot inside an obstacle, where the force is beyond all bounds."""
    if hit := first_hit(scenario, run.recording):
        raise _stopped(
            scenario,
            run,
            hit.time,
            hit.robot,
            f"robot {hit.robot} is inside obstacle {hit.obstacle} at t = {hit.time:.6g} s. Try other starting "
            "positions, another place for the obstacle, or a larger avoidance.gain.",
        )


def _with_shorter_steps(scenario: Scenario, run: Engine, leap: Leap) -> Scenario:
    """The scenario with steps that overlook no obstacle.

    Raises:
        SimulationError: the user wants all steps to have one length, or there would be too many.
    """
    settings = scenario.simulator
    if run.fixed_step or (resolve(scenario).end - settings.start_time) / leap.longest > MOST_STEPS:
        raise _stopped(
            scenario,
            run,
            leap.time,
            leap.robot,
            f"robot {leap.robot} passes obstacle {leap.obstacle} at t = {leap.time:.6g} s so fast that steps of "
            f"{settings.max_step_size:g} s may overlook it. Try simulator.max_step_size={leap.longest:.2g}, or a "
            "larger avoidance.range.",
        )
    return scenario.model_copy(update={"simulator": settings.model_copy(update={"max_step_size": leap.longest})})


def _stopped(scenario: Scenario, run: Engine, time: float, robot: int, message: str) -> SimulationError:
    return SimulationError(message, time, robot, labelled_result(scenario, time_series(scenario, run.recording, None)))


# Drake's own complaints, and Python's from the laws: coincident robots divide by zero.
_FAILURES = (RuntimeError, ArithmeticError, SystemExit)


def _simulation_error(
    scenario: Scenario, failed: Engine, run: Recording, nominal: Recording | None, failure: BaseException
) -> SimulationError:
    """Say when, which robot, why and what to try."""
    time = failed.recording.times[-1] if len(failed.recording.times) else failed.context.get_time()
    robot = _culprit(failed)
    reasons: dict[type[BaseException], str] = {
        NonFiniteStateError: "its state is no longer finite",
        ZeroDivisionError: "it met another robot",
        OverflowError: "its forces grew beyond all bounds",
    }
    reason = reasons.get(type(failure), f"the integrator gave up ({failure})")
    message = f"the run stopped at t = {time:.6g} s at robot {robot}: {reason}. Try {_advice(scenario, failed)}."
    return SimulationError(message, float(time), robot, labelled_result(scenario, time_series(scenario, run, nominal)))


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
