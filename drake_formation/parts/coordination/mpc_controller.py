"""The block of one robot under model predictive control: a plan at every sample, its first force held in between."""

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import BasicVector, LeafSystem

from drake_formation.parts.coordination.planning import InfeasibleError, best_plan, constraints
from drake_formation.parts.coordination.prediction import prediction
from drake_formation.parts.part import PartFailedError
from drake_formation.parts.roles import STATE

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Schedule:
    """When plans are made.

    Attributes:
        period: between samples (s).
        horizon: samples ahead that a plan is made for, H.
    """

    period: float
    horizon: int


class MpcController(LeafSystem):  # type: ignore[misc]
    """One robot of N that all solve the same problem, of which each applies its own force.

    It is in double only: a quadratic program has no derivative and no symbols. Input ports: ``state`` and, for each
    other robot, ``channel_j`` (size 4), ``reference`` (size 6) and ``phase``. Output port: ``force`` (N, size 2).
    Discrete state: the plan (N, 2NH numbers), at first 0, updated at every multiple of the period. Parameters, over the
    robots in their order: 0, force limits (N, infinite for none, N numbers); 1, distances to keep from obstacles (m,
    minus infinity for none, N numbers); 2, slots (m, 2N numbers); 3, centre and radius of every obstacle (m, 3M
    numbers); 4 and 5, the :class:`~drake_formation.parts.coordination.prediction.SampledModel` without the object and
    with it.

    Args:
        robot: which one, from 0.
        schedule: when it plans.
        numbers: the parameters.
    """

    def __init__(self, robot: int, schedule: Schedule, numbers: Sequence[Array]) -> None:
        super().__init__()
        self._robot, self._schedule = robot, schedule
        self._robots = len(numbers[0])
        names = ["state" if j == robot else f"channel_{j + 1}" for j in range(self._robots)]
        self._states = [self.DeclareVectorInputPort(name, STATE) for name in names]
        self._reference = self.DeclareVectorInputPort("reference", 6)
        self._phase = self.DeclareVectorInputPort("phase", 1)
        for group in numbers:
            self.DeclareNumericParameter(BasicVector(np.ravel(group)))
        self.DeclareDiscreteState(2 * self._robots * schedule.horizon)
        self.DeclarePeriodicDiscreteUpdateEvent(schedule.period, 0.0, self._plan)
        self.DeclareVectorOutputPort("force", 2, self._calc_force, {self.xd_ticket(), self.time_ticket()})

    def _calc_force(self, context: Any, output: Any) -> None:
        plan = context.get_discrete_state_vector().CopyToVector()
        output.SetFromVector(plan[2 * self._robot : 2 * self._robot + 2])

    def _plan(self, context: Any, discrete_state: Any) -> None:
        numbers = [context.get_numeric_parameter(k).CopyToVector() for k in range(6)]
        known = [port.Eval(context) for port in (*self._states, self._reference, self._phase)]
        last = context.get_discrete_state_vector().CopyToVector()
        try:
            plan = found(self._schedule, tuple(values.tobytes() for values in (*numbers, np.concatenate(known), last)))
        except InfeasibleError as failure:
            raise self._failed(failure, limits=numbers[0], distance=numbers[1]) from failure
        discrete_state.set_value(plan)

    def _failed(self, failure: InfeasibleError, limits: Array, distance: Array) -> PartFailedError:
        robot = failure.robot
        within = f"of at most {limits[robot]:g} N " if math.isfinite(limits[robot]) else ""
        message = (
            f"no forces {within}keep it {distance[robot]:g} m from obstacle {failure.obstacle + 1} over the next "
            f"{self._schedule.period * self._schedule.horizon:g} s; {failure.missing:.2g} m are missing"
        )
        return PartFailedError(message, robot + 1, "a larger consensus.limit or horizon, or a smaller clearance")


@functools.lru_cache(maxsize=8)
def found(schedule: Schedule, knowledge: tuple[bytes, ...]) -> Array:
    """The plan; robots that know the same find the same one, so it is looked for once.

    Args:
        schedule: of the robots.
        knowledge: as bytes the six numeric parameters, then the states of all robots, the reference and the phase in
            one row, and the last plan.

    Raises:
        InfeasibleError: there is none.
    """
    limits, distance, slots, obstacles, gathering, carrying, known, last = map(np.frombuffer, knowledge)
    robots = len(limits)
    states, centre = known[: STATE * robots].reshape(robots, STATE), known[STATE * robots :][:STATE]
    transport = known[-1] > 0.5
    predicted = prediction((carrying if transport else gathering).tobytes(), robots, schedule.horizon)
    at_slots = np.hstack([slots.reshape(robots, 2), np.zeros((robots, 2))])
    errors = (states - centre - at_slots).ravel()
    kept = constraints(
        predicted,
        now=states[:, :2],
        free_path=predicted.paths(at_slots[:, :2], centre, schedule.period, errors),
        guess=np.concatenate([last[2 * robots :], np.zeros(2 * robots)]),  # the last plan, a sample later
        limits=limits,
        obstacles=obstacles.reshape(-1, 3) if transport else np.zeros((0, 3)),
        distance=distance,
    )
    return best_plan(predicted, errors, kept)
