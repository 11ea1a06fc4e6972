"""Run a scenario: aggregation, hand-off, transport, and the obstacle-free response."""

from typing import TYPE_CHECKING

import numpy as np
from pydrake.systems.framework import Context, Diagram

from drake_formation.diagram import build_diagram
from drake_formation.lowering.errors import LoweringError
from drake_formation.parameters import Parameters, block_parameters, structure, write_parameters
from drake_formation.scenario import Scenario, derive, require_sound
from drake_formation.simulation.choice import Choice, choose
from drake_formation.simulation.clearance import contact
from drake_formation.simulation.engines import ENGINES, Engine, Start
from drake_formation.simulation.phases import Progress, felt_obstacles, without_obstacles
from drake_formation.simulation.recorder import NonFiniteStateError, Recording
from drake_formation.simulation.result import labelled_result
from drake_formation.simulation.series import Series, time_series

if TYPE_CHECKING:
    import xarray as xr


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


AUTO = "auto"


def simulate(scenario: Scenario, *, engine: str = AUTO, progress: Progress | None = None) -> "xr.Dataset":
    """Run a scenario from its initial state to its end.

    Where there are obstacles, the transport is run once more from the hand-off without them: the deviation from that
    response is the paper's tracking error.

    Args:
        scenario: what to run.
        engine: ``blocks``, the diagram on Drake's Simulator, which is the reference; ``compiled``, code derived from
            the same diagram, or ``exponential``, which integrates the linear part of that code exactly, both in place
            of ``runge_kutta5`` only; or ``auto``, the blocks where they are done before they could be compiled or
            cannot be compiled, else the compiled ones (:mod:`drake_formation.simulation.choice`).
        progress: called as the simulated time goes on.

    Returns:
        The labelled result; see :func:`drake_formation.simulation.result.labelled_result`. Its attribute ``engine``
        names what ran it, and ``engine_reason`` why, where that was chosen.

    Raises:
        ValueError: there is no such engine.
        ScenarioError: the scenario is wrong, or asks for what the engine named does not have.
        LoweringError: a block of the diagram cannot be compiled by the engine named.
        SimulationError: the run diverged or the integrator gave up; it carries what was recorded.
    """
    return labelled_result(PreparedRun(scenario, engine=engine).run(scenario, progress=progress))


class PreparedRun:
    """A diagram, built and made ready once, that runs every scenario of its structure.

    A run depends on its scenario alone, not on what ran before.

    Args:
        scenario: gives the structure; see :func:`drake_formation.parameters.structure`.
        engine: as for :func:`simulate`; ``auto`` goes by this scenario.

    Attributes:
        diagram: the diagram.
        structure: of the scenarios it runs.
        choice: what runs them, and why where that was chosen.

    Raises:
        ValueError, ScenarioError, LoweringError: as for :func:`simulate`.
    """

    def __init__(self, scenario: Scenario, *, engine: str = AUTO) -> None:
        if engine not in (AUTO, *ENGINES):
            raise ValueError(f"no engine {engine!r}; there are {', '.join((AUTO, *ENGINES))}")
        self.diagram = build_diagram(scenario)
        self.structure = structure(scenario)
        self.choice, self._start = _chosen(scenario, self.diagram) if engine == AUTO else _asked(engine, self.diagram)
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
        require_sound(scenario)
        parameters = block_parameters(scenario)
        if structure(scenario, parameters) != self.structure:
            raise ValueError(f"scenario {scenario.name!r} has another structure than the diagram made ready")
        return self.run_known(scenario, parameters, progress=progress)

    def run_known(self, scenario: Scenario, parameters: Parameters, *, progress: Progress | None = None) -> Series:
        """Run a sound scenario that is known to have the structure, and whose numbers are known.

        Args:
            scenario: what to run.
            parameters: its numbers, as :func:`drake_formation.parameters.block_parameters` gives them.
            progress: called as the simulated time goes on.

        Returns:
            As :meth:`run`.

        Raises:
            ScenarioError, SimulationError: as for :func:`simulate`.
        """
        begin, hand_off, end = scenario.simulator.start_time, derive.hand_off_time(scenario), derive.end_time(scenario)
        context = self._initial_context(scenario, parameters)
        run = self._start(scenario, context, progress and (lambda time: progress(time - begin)))
        try:
            run.advance(hand_off)
            # Carry out the hand-off now, so that the first sample of the transport has its forces.
            run.carry_out_updates()
            at_hand_off = run.context.Clone() if felt_obstacles(scenario) else None
            run.advance(end)
        except _FAILURES as failure:
            raise _simulation_error(run, self._series(scenario, run.recording, None), failure) from failure
        if at_hand_off is None:
            return self._series(scenario, run.recording, run.recording)

        write_parameters(self.diagram, at_hand_off, block_parameters(without_obstacles(scenario)))
        nominal = self._start(
            scenario, at_hand_off, progress and (lambda time: progress(end - begin + time - hand_off))
        )
        try:
            nominal.advance(end)
        except _FAILURES as failure:
            raise _simulation_error(
                nominal, self._series(scenario, run.recording, nominal.recording), failure
            ) from failure
        series = self._series(scenario, run.recording, nominal.recording)
        _require_clear(series)
        return series

    def _series(self, scenario: Scenario, run: Recording, nominal: Recording | None) -> Series:
        return time_series(scenario, self.choice, run, nominal)

    def _initial_context(self, scenario: Scenario, parameters: Parameters) -> Context:
        context = self._context  # one for all runs, as making one takes as long as some runs
        context.SetTime(scenario.simulator.start_time)
        self.diagram.SetDefaultContext(context)
        write_parameters(self.diagram, context, parameters)
        starts = derive.starts(scenario)
        context.SetContinuousState(np.hstack([starts, np.zeros_like(starts)]).ravel())
        return context


def _chosen(scenario: Scenario, diagram: Diagram) -> tuple[Choice, Start]:
    """The fastest engine for a scenario, made ready; the blocks where another does not get ready."""
    choice = choose(scenario)
    try:
        return choice, ENGINES[choice.engine](diagram)
    except LoweringError as error:
        return _asked("blocks", diagram, str(error))


def _asked(engine: str, diagram: Diagram, reason: str = "") -> tuple[Choice, Start]:
    return Choice(engine, reason), ENGINES[engine](diagram)


def _require_clear(series: Series) -> None:
    """A robot inside an obstacle feels no force there: say so instead of carrying on as if nothing were in its way."""
    found = contact(series)
    if found is None:
        return
    time, robot, obstacle = found
    raise SimulationError(
        f"robot {robot + 1} is inside obstacle {obstacle + 1} at t = {time:.6g} s. Try other starting positions, "
        "another place for the obstacle, or a larger avoidance.gain.",
        time,
        robot + 1,
        labelled_result(series),
    )


# Drake's own complaints, and Python's from the laws: coincident robots divide by zero.
_FAILURES = (RuntimeError, ArithmeticError, SystemExit)


def _simulation_error(failed: Engine, series: Series, failure: BaseException) -> SimulationError:
    """Say when, which robot, why and what to try."""
    time = failed.recording.times[-1] if len(failed.recording.times) else failed.context.get_time()
    robot = _culprit(failed)
    reasons: dict[type[BaseException], str] = {
        NonFiniteStateError: "its state is no longer finite",
        ZeroDivisionError: "it met another robot or the middle of an obstacle",
        OverflowError: "its forces grew beyond all bounds",
    }
    reason = reasons.get(type(failure), f"the integrator gave up ({failure})")
    message = f"the run stopped at t = {time:.6g} s at robot {robot}: {reason}. Try {_advice(series.scenario, failed)}."
    return SimulationError(message, float(time), robot, labelled_result(series))


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
