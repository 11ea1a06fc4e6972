"""Run a scenario: aggregation, hand-off, transport, and the obstacle-free response."""

from typing import TYPE_CHECKING

import numpy as np
from pydrake.systems.framework import Context, Diagram

from drake_formation.diagram import build_diagram
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import robot_name
from drake_formation.lowering.errors import LoweringError
from drake_formation.parameters import (
    block_parameters,
    find_block,
    placed_parts,
    structure,
    write_parameters,
    write_start,
)
from drake_formation.parts.part import PartFailedError
from drake_formation.scenario import Scenario, ScenarioError, resolve
from drake_formation.simulation.choice import Choice, choose
from drake_formation.simulation.clearance import contact
from drake_formation.simulation.engine import Engine, Start
from drake_formation.simulation.engines import ENGINES
from drake_formation.simulation.obstacles import Leap, first_hit, worst_leap
from drake_formation.simulation.phases import Progress, felt_obstacles, without_obstacles
from drake_formation.simulation.recorder import FARTHEST, BeyondBoundsError, NonFiniteStateError, Recording
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

MOST_STEPS = 200_000
"""A run that would need more of them, as its obstacles are so small, is refused."""

JUST_BEFORE = 1e-6
"""How long before a failure a sample is taken (s)."""


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
        self.structure = structure(resolve(scenario))
        self.choice = choose(scenario) if engine == AUTO else Choice(engine, "")
        try:
            self._start = _ready(self.choice.engine, self.diagram, resolve(scenario))
        except LoweringError as error:
            if engine != AUTO:
                raise
            self.choice, self._start = Choice("blocks", str(error)), ENGINES["blocks"](self.diagram)
        self._context = self.diagram.CreateDefaultContext()
        self._robots = resolve(scenario).robots

    @classmethod
    def compiled(cls, scenario: Scenario) -> "PreparedRun":
        """The diagram compiled, for many runs; or as the scenario runs best, where it cannot be."""
        try:
            return cls(scenario, engine="compiled")
        except (LoweringError, ScenarioError):
            return cls(scenario)

    def run(self, scenario: Scenario, *, progress: Progress | None = None) -> Series:
        """Run a scenario of the same structure.

        Args:
            scenario: what to run.
            progress: called as the simulated time goes on.

        Returns:
            The variables of the labelled result as plain arrays, which :func:`drake_formation.measuring.measure` takes.

        Raises:
            ScenarioError, SimulationError: as for :func:`simulate`.
            ValueError: its structure differs.
        """
        if structure(resolve(scenario)) != self.structure:
            raise ValueError(f"scenario {scenario.name!r} has another structure than the diagram made ready")
        return self.run_known(scenario, progress=progress)

    def run_known(self, scenario: Scenario, *, progress: Progress | None = None) -> Series:
        """Run a scenario that is known to have the structure.

        Where its steps might leap over what an obstacle exerts, it is run again with shorter ones.

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
            if hand_off > begin:
                run.carry_out_updates()  # so that the first sample has their forces, whatever the engine
                _advance(run, formation, hand_off)
            at_hand_off = run.context.Clone() if felt_obstacles(formation) else None
            # Carry out the hand-off now, so that the first sample of the transport has its forces.
            run.carry_out_updates()
            _advance(run, formation, end)
        except _FAILURES as failure:
            if felt_obstacles(formation) and len(run.recording.times):
                self._require_clear(scenario, run)
                if leap := worst_leap(scenario, run.recording):
                    return self.run_known(self._with_shorter_steps(scenario, run, leap), progress=progress)
            raise self._simulation_error(run, self._series(scenario, run.recording, None), failure) from failure
        if at_hand_off is None:
            return self._series(scenario, run.recording, run.recording)
        self._require_clear(scenario, run)
        if leap := worst_leap(scenario, run.recording):
            return self.run_known(self._with_shorter_steps(scenario, run, leap), progress=progress)

        write_parameters(self.diagram, at_hand_off, block_parameters(without_obstacles(formation)))
        nominal = self._start(
            scenario, at_hand_off, progress and (lambda time: progress(end - begin + time - hand_off))
        )
        try:
            nominal.carry_out_updates()
            _advance(nominal, formation, end)
        except _FAILURES as failure:
            raise self._simulation_error(
                nominal, self._series(scenario, run.recording, nominal.recording), failure
            ) from failure
        series = self._series(scenario, run.recording, nominal.recording)
        _require_no_contact(series)
        return series

    def _series(self, scenario: Scenario, run: Recording, nominal: Recording | None) -> Series:
        return time_series(scenario, self.choice, run, nominal)

    def _initial_context(self, formation: Formation) -> Context:
        context = self._context  # one for all runs, as making one takes as long as some runs
        context.SetTime(formation.begin)
        self.diagram.SetDefaultContext(context)
        write_parameters(self.diagram, context, block_parameters(formation))
        write_start(self.diagram, context, formation)
        return context

    def _require_clear(self, scenario: Scenario, run: Engine) -> None:
        """Refuse a run with a robot inside an obstacle, where the force is beyond all bounds."""
        if hit := first_hit(scenario, run.recording):
            raise _inside(hit.time, hit.robot, hit.obstacle, self._series(scenario, run.recording, None))

    def _with_shorter_steps(self, scenario: Scenario, run: Engine, leap: Leap) -> Scenario:
        """The scenario with steps that overlook no obstacle.

        Raises:
            SimulationError: the user wants all steps to have one length, or there would be too many.
        """
        settings = scenario.simulator
        if run.fixed_step or (resolve(scenario).end - settings.start_time) / leap.longest > MOST_STEPS:
            raise SimulationError(
                f"robot {leap.robot} passes obstacle {leap.obstacle} at t = {leap.time:.6g} s so fast that steps of "
                f"{settings.max_step_size:g} s may overlook it. Try simulator.max_step_size={leap.longest:.2g}, or a "
                "larger avoidance.range.",
                leap.time,
                leap.robot,
                labelled_result(self._series(scenario, run.recording, None)),
            )
        return scenario.model_copy(update={"simulator": settings.model_copy(update={"max_step_size": leap.longest})})

    def _simulation_error(self, failed: Engine, series: Series, failure: BaseException) -> SimulationError:
        """Say when, which robot, why and what to try."""
        time = failed.recording.times[-1] if len(failed.recording.times) else failed.context.get_time()
        if isinstance(failure, PartFailedError):
            robot, reason, advice = failure.robot, str(failure), failure.advice
        else:
            robot, reason, advice = self._culprit(failed), _reason(failure), _advice(series.scenario, failed)
        message = f"the run stopped at t = {time:.6g} s at robot {robot}: {reason}. Try {advice}."
        return SimulationError(message, float(time), robot, labelled_result(series))

    def _culprit(self, run: Engine) -> int:
        """Of the robots whose state is not finite, or else of all, the one that was fastest at last; from 1."""
        last = run.recording.series("state")[-1] if len(run.recording.times) else None
        finite, speeds = [], []
        for i in range(self._robots):
            own = find_block(self.diagram, f"{robot_name(i)}/plant").GetMyContextFromRoot(run.context)
            finite.append(bool(np.isfinite(own.get_continuous_state_vector().CopyToVector()).all()))
            speeds.append(0.0 if last is None else float(np.abs(last[i, 2:]).max()))
        lost = ~np.array(finite)
        return int(np.argmax(np.where(lost | ~lost.any(), speeds, -1.0))) + 1


def _ready(engine: str, diagram: Diagram, formation: Formation) -> Start:
    """An engine made ready for a formation's diagram; a block that it cannot compile is named with its part."""
    try:
        return ENGINES[engine](diagram)
    except LoweringError as error:
        for path, part, _ in placed_parts(formation):
            if f"{error.block}/".startswith(f"{path}/"):
                law = f" with {formation.law.called()}" if part.role == "robot" else ""
                raise LoweringError(error.block, f"{error.reason} ({part.called()}{law})") from error
        raise


def _advance(run: Engine, formation: Formation, end: float) -> None:
    """Go on to a time (s), by the failures on the way.

    Samples at them show what is so from then on; others just before show what was, as what is read between samples
    is drawn from the one to the next.
    """
    begin = run.context.get_time()
    for stage in formation.stages:
        if begin < stage.time < end:
            run.advance(max(run.context.get_time(), stage.time - JUST_BEFORE))
            run.advance(stage.time)
            run.carry_out_updates()
    run.advance(end)


def _require_no_contact(series: Series) -> None:
    """Refuse a run in which a robot is inside an obstacle between two samples."""
    found = contact(series)
    if found is not None:
        time, robot, obstacle = found
        raise _inside(time, robot + 1, obstacle + 1, series)


def _inside(time: float, robot: int, obstacle: int, series: Series) -> SimulationError:
    message = (
        f"robot {robot} is inside obstacle {obstacle} at t = {time:.6g} s. Try other starting positions, "
        "another place for the obstacle, or a larger avoidance.gain."
    )
    return SimulationError(message, time, robot, labelled_result(series))


# Drake's own complaints, and Python's from the laws: coincident robots divide by zero.
_FAILURES = (RuntimeError, ArithmeticError, SystemExit)


def _reason(failure: BaseException) -> str:
    reasons: dict[type[BaseException], str] = {
        NonFiniteStateError: "its state is no longer finite",
        BeyondBoundsError: f"its state grew beyond {FARTHEST:g} (m, m/s)",
        ZeroDivisionError: "it met another robot",
        OverflowError: "its forces grew beyond all bounds",
    }
    return reasons.get(type(failure), f"the integrator gave up ({failure})")


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
