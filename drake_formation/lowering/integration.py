"""Carrying a compiled right-hand side forward in time, from one update of a diagram to the next."""

import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.lowering import cache
from drake_formation.lowering.phi import phi_functions
from drake_formation.lowering.schedule import Table

Array = NDArray[np.float64]

CHUNK = 4096
"""Samples after which a compiled integrator reports."""
LEVELS = 14
"""The exponential method's shortest steps are the longest halved so many times."""
FIRST_LEVEL = 3.0
"""Halvings of its first step: Drake starts with a tenth of the largest, and this is the level nearest to it."""


class Status(IntEnum):
    """Why an integration returned; the numbers are those of the compiled integrators."""

    DONE = 0
    FULL = 1
    NOT_FINITE = 2
    STEP_TOO_SMALL = 3


@dataclass(frozen=True)
class Trajectory:
    """Samples of the continuous state between two times.

    Attributes:
        times: sample times (s), shape (samples,).
        states: shape (samples, states).
        values: what :meth:`CompiledDiagram.read` gave, as it was meanwhile.
        status: ``DONE``, or why it ends early.
        reached: where the integration stands (s).
        evaluations: derivatives evaluated.
        rejected: steps rejected.
    """

    times: Array
    states: Array
    values: Array
    status: Status
    reached: float
    evaluations: int
    rejected: int


@dataclass(frozen=True)
class Flow:
    """ẋ = f(t, x) as compiled code between two updates of a diagram.

    Attributes:
        derivatives: ``derivatives(t, x, values, table, dx)``.
        table: its table.
        values: its memory.
    """

    derivatives: Callable[..., None]
    table: Table
    values: Array

    def jacobian(self, time: float, state: Array) -> Array:
        """∂f/∂x by central differences, shape (states, states); zero where f is not finite."""
        columns = []
        point, high, low = state.copy(), np.empty(len(state)), np.empty(len(state))
        for k, value in enumerate(state.tolist()):
            step = 1e-6 * max(1.0, abs(value))
            point[k] = value + step
            self.derivatives(time, point, self.values, self.table, high)
            point[k] = value - step
            self.derivatives(time, point, self.values, self.table, low)
            point[k] = value
            columns.append((high - low) / (2.0 * step))
        result = np.array(columns).T.copy()
        return result if np.isfinite(result).all() else np.zeros_like(result)


@dataclass(frozen=True)
class Steps:
    """How to step.

    Attributes:
        accuracy: largest error of any state in one step.
        longest: longest step (s).
        adaptive: control the step; else every step is the longest.
    """

    accuracy: float = 1e-6
    longest: float = 0.1
    adaptive: bool = True


Method = Callable[[Flow, float, float, Array, Steps, Array, bool], Iterator[Trajectory]]
"""Carries a state, which goes along, from a time to another. Samples every step, or else at the times given alone."""


def dormand_prince(
    flow: Flow, begin: float, end: float, state: Array, steps: Steps, at: Array, every: bool
) -> Iterator[Trajectory]:
    """The Dormand-Prince 5(4) pair with dense output; see :mod:`drake_formation.lowering.dormand_prince`."""
    integrate = _compiled("dormand_prince")
    clock = np.array([begin, 0.1 * steps.longest, 1e-4])  # Drake starts with a tenth of the largest step too
    wanted = np.zeros(0) if every else (at if len(at) else np.array([np.inf]))
    status = Status.FULL
    while status == Status.FULL:
        times, states = _room(CHUNK if every else len(wanted), state)
        code, count, evaluations, rejected = integrate(
            flow.derivatives, clock, end, state, flow.values, flow.table, steps.accuracy, steps.longest,
            steps.adaptive, wanted, times, states,
        )  # fmt: skip
        status = Status(code)
        yield Trajectory(times[:count], states[:count], flow.values, status, clock[0], evaluations, rejected)


def exponential(
    flow: Flow, begin: float, end: float, state: Array, steps: Steps, at: Array, every: bool
) -> Iterator[Trajectory]:
    """An exponential Runge-Kutta method of order 4; see :mod:`drake_formation.lowering.exponential`.

    It is linearized where it starts, and anew after every piece. Where it samples at given times its steps end at
    them, which is quickest where they are evenly spaced.
    """
    integrate = _compiled("exponential")
    clock = np.array([begin, FIRST_LEVEL])
    stops = np.zeros(0) if every else at[at > begin]
    at_begin = not every and len(at) > len(stops)
    if at_begin:
        yield Trajectory(
            np.array([begin]), state[None].copy(), flow.values, Status.FULL, begin, evaluations=0, rejected=0
        )
    ends = stops if len(stops) and stops[-1] == end else np.append(stops, end)
    for length, group in _evenly_spaced(begin, ends):
        finished = False
        while not finished:
            remaining = group[group > clock[0]]
            span = remaining[0] - clock[0] if every else length
            pair = span / np.ceil(span / (2.0 * steps.longest) - 1e-9)
            jacobian = flow.jacobian(clock[0], state)
            functions = phi_functions(pair * jacobian, LEVELS)
            times, states = _room(CHUNK if every else len(remaining), state)
            code, count, evaluations, rejected = integrate(
                flow.derivatives, clock, remaining, state, flow.values, flow.table, jacobian, functions, pair,
                steps.accuracy, steps.adaptive, every, times, states,
            )  # fmt: skip
            status, finished = Status(code), code != Status.FULL
            if status == Status.DONE and clock[0] < end:
                status = Status.FULL
            sampled = count if every or len(at) else 0
            if sampled and not every and times[sampled - 1] > at[-1]:
                sampled -= 1  # the end, which nobody asked for
            yield Trajectory(
                times[:sampled], states[:sampled], flow.values, status, clock[0], evaluations + 2 * len(state), rejected
            )
            if status in (Status.NOT_FINITE, Status.STEP_TOO_SMALL):
                return


METHODS: dict[str, Method] = {"dormand_prince": dormand_prince, "exponential": exponential}


def _room(samples: int, state: Array) -> tuple[Array, Array]:
    return np.empty(samples), np.empty((samples, len(state)))


def _evenly_spaced(begin: float, stops: Array) -> Iterator[tuple[float, Array]]:
    """Stops in groups that lie apart by one length, with the length."""
    lengths = np.diff(stops, prepend=begin)
    tolerance = 1e-9 * max(1.0, float(np.abs(stops).max()))
    rounded = np.round(lengths / tolerance)
    for _, members in groupby(range(len(stops)), key=lambda k: rounded[k]):
        chosen = list(members)
        yield float(lengths[chosen[0]]), stops[chosen]


@functools.cache
def _compiled(method: str) -> Any:
    """A compiled integrator, which is the same for all diagrams."""
    source = Path(__file__).with_name(f"{method}.py").read_text(encoding="utf-8")
    return cache.load(source).integrate
