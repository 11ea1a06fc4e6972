"""The block of one robot under model predictive control: a plan at every sample, its first force held in between."""

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
        limits, distance, slots, obstacles = (
            numbers[0],
            numbers[1],
            numbers[2].reshape(-1, 2),
            numbers[3].reshape(-1, 3),
        )
        carrying = self._phase.Eval(context)[0] > 0.5
        if not carrying:
            obstacles = obstacles[:0]  # they are felt in the transport
        predicted = prediction(numbers[5 if carrying else 4].tobytes(), self._robots, self._schedule.horizon)
        states = np.array([port.Eval(context) for port in self._states])
        centre = self._reference.Eval(context)[:STATE]
        errors = (states - centre - np.hstack([slots, np.zeros_like(slots)])).ravel()
        free_path = predicted.paths(slots, centre, self._schedule.period, errors)
        guess = _moved_on(context.get_discrete_state_vector().CopyToVector(), 2 * self._robots)
        kept = constraints(predicted, states[:, :2], free_path, guess, limits, obstacles, distance)
        try:
            discrete_state.set_value(best_plan(predicted, errors, kept))
        except InfeasibleError as failure:
            raise self._failed(failure, limits, distance) from failure

    def _failed(self, failure: InfeasibleError, limits: Array, distance: Array) -> PartFailedError:
        robot = failure.robot
        within = f"of at most {limits[robot]:g} N " if math.isfinite(limits[robot]) else ""
        message = (
            f"no forces {within}keep it {distance[robot]:g} m from obstacle {failure.obstacle + 1} over the next "
            f"{self._schedule.period * self._schedule.horizon:g} s; {failure.missing:.2g} m are missing"
        )
        return PartFailedError(message, robot + 1, "a larger consensus.limit or horizon, or a smaller clearance")


def _moved_on(plan: Array, forces: int) -> Array:
    """A plan one sample later, with no force at its end."""
    return np.concatenate([plan[forces:], np.zeros(forces)])
