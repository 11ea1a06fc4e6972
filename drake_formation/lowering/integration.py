"""Carrying a compiled right-hand side forward in time, from one update of a diagram to the next."""

import functools
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from enum import IntEnum
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation import machine_code
from drake_formation.lowering.phi import phi_functions
from drake_formation.lowering.schedule import Table
from drake_formation.lowering.ticks import Ticks

Array = NDArray[np.float64]

CHUNK = 4096
"""Samples after which a compiled integrator reports."""
LEVELS = 14
"""The exponential method's shortest steps are the longest halved so many times."""
JUMPED = 6
"""Halvings of two longest steps that the other method takes over for."""
NEARLY = 1e-6
"""Share of a length by which rounding may change it."""
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
        recorded: what was to be recorded at the samples, shape (samples, numbers).
        status: ``DONE``, or why it ends early.
        reached: where the integration stands (s).
        evaluations: derivatives evaluated.
        rejected: steps rejected.
    """

    times: Array
    states: Array
    recorded: Array
    status: Status
    reached: float
    evaluations: int
    rejected: int


@dataclass(frozen=True)
class Recorder:
    """What is recorded at every sample.

    Attributes:
        outputs: ``outputs(times, states, values, table, addresses, recorded)``.
        table: its table.
        addresses: where the numbers stand in its memory.
    """

    outputs: Callable[..., None]
    table: Table
    addresses: Table

    def at(self, times: Array, states: Array, values: Array) -> Array:
        """The numbers at some samples, shape (samples, numbers), with some memory, which is left as it is."""
        result = np.empty((len(times), len(self.addresses)))
        if len(self.addresses):
            memory = values.copy()
            arrays = np.ascontiguousarray(times), np.ascontiguousarray(states)
            self.outputs(*arrays, memory, self.table, self.addresses, result)
        return result


@dataclass(frozen=True)
class Events:
    """The updates of a diagram as compiled code.

    Attributes:
        ticks: when they are.
        prepare: ``prepare(values, table)``, with the table of the derivatives.
        update: ``update(t, values, update_table, due)``.
        table: its table.
    """

    ticks: list[Ticks]
    prepare: Callable[..., None]
    update: Callable[..., None]
    table: Table


@dataclass(frozen=True)
class Flow:
    """ẋ = f(t, x) as compiled code between two updates of a diagram.

    Attributes:
        derivatives: ``derivatives(t, x, values, table, dx)``.
        table: its table.
        values: its memory.
        recorder: what is recorded.
    """

    derivatives: Callable[..., None]
    table: Table
    values: Array
    recorder: Recorder

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
    integrate = _compiled("dormand_prince").integrate
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
        recorded = flow.recorder.at(times[:count], states[:count], flow.values)
        yield Trajectory(times[:count], states[:count], recorded, status, clock[0], evaluations, rejected)


def through_events(
    flow: Flow,
    events: Events,
    begin: float,
    end: float,
    state: Array,
    steps: Steps,
    at: Array,
    every: bool,
    updated: bool,
) -> Iterator[Trajectory]:
    """The Dormand-Prince pair through the updates of a diagram; see :mod:`drake_formation.lowering.event_loop`.

    Args:
        flow: right-hand side; the discrete state in its memory goes along.
        events: the updates.
        begin: where to start (s).
        end: where to stop (s); updates due then are not carried out.
        state: goes along.
        steps: how to step.
        at: times to sample at (s).
        every: sample every step instead.
        updated: whether the updates due at the start have been carried out.
    """
    clock = np.array([begin, 0.1 * steps.longest, 1e-4])
    offsets, periods = (np.array([getattr(ticks, name) for ticks in events.ticks]) for name in ("offset", "period"))
    counts = np.array([ticks.first(begin) for ticks in events.ticks])
    wanted = np.zeros(0) if every else (at if len(at) else np.array([np.inf]))
    recorder, status = flow.recorder, Status.FULL
    while status == Status.FULL:
        times, states = _room(CHUNK if every else len(wanted), state)
        recorded = np.empty((len(times), len(recorder.addresses)))
        code, count, evaluations, rejected = _compiled("event_loop").run(
            _compiled("dormand_prince").integrate, flow.derivatives, events.prepare, events.update, recorder.outputs,
            clock, end, state, flow.values, flow.table, events.table, recorder.table, recorder.addresses, offsets,
            periods, counts, updated, steps.accuracy, steps.longest, steps.adaptive, wanted, times, states, recorded,
        )  # fmt: skip
        status, updated = Status(code), False
        yield Trajectory(times[:count], states[:count], recorded[:count], status, clock[0], evaluations, rejected)


def no_outputs() -> Callable[..., None]:
    """What records nothing."""
    nothing: Callable[..., None] = _compiled("event_loop").nothing
    return nothing


def exponential(
    flow: Flow, begin: float, end: float, state: Array, steps: Steps, at: Array, every: bool
) -> Iterator[Trajectory]:
    """An exponential Runge-Kutta method of order 4; see :mod:`drake_formation.lowering.exponential`.

    It is linearized where it starts, and anew after every piece. Where it samples at given times its steps end at
    them, which is quickest where they are evenly spaced. Where its shortest steps are too long, as they are across a
    jump of the derivatives, the Dormand-Prince pair takes over for a moment. Without continuous state there is nothing
    to linearize.
    """
    if not len(state):
        yield from dormand_prince(flow, begin, end, state, steps, at, every)
        return
    if len(at) and at[0] == begin:
        start = at[:1], state[None].copy()
        recorded = flow.recorder.at(*start, flow.values)
        yield Trajectory(*start, recorded, Status.FULL, begin, evaluations=0, rejected=0)
    wanted = at[at > begin]
    targets = wanted if len(wanted) and wanted[-1] == end else np.append(wanted, end)
    clock = np.array([begin, FIRST_LEVEL])
    for length, group in _evenly_spaced(begin, targets):
        while clock[0] < group[-1]:
            remaining = group[group > clock[0]]
            evenly = not every and abs(clock[0] + length - remaining[0]) <= NEARLY * length  # no jump has come between
            span = length if evenly else remaining[0] - clock[0]
            for piece in _exponential_piece(
                flow, clock, state, steps, every, remaining if evenly else remaining[:1], span
            ):
                named = piece if every or not len(piece.times) or piece.times[-1] in wanted else _shortened(piece)
                yield replace(named, status=Status.FULL) if piece.status == Status.DONE and clock[0] < end else named
                if piece.status in (Status.NOT_FINITE, Status.STEP_TOO_SMALL):
                    return


def _shortened(piece: Trajectory) -> Trajectory:
    """A piece without its last sample: the end, which nobody asked for."""
    return replace(piece, times=piece.times[:-1], states=piece.states[:-1], recorded=piece.recorded[:-1])


def _exponential_piece(
    flow: Flow, clock: Array, state: Array, steps: Steps, every: bool, stops: Array, span: float
) -> Iterator[Trajectory]:
    """To some stops that lie a span apart, or as far as there is room; clock and state go along."""
    pair = span / max(1.0, np.ceil(span / (2.0 * steps.longest) - 1e-9))
    jacobian = flow.jacobian(clock[0], state)
    functions = phi_functions(pair * jacobian, LEVELS)
    times, states = _room(CHUNK if every else len(stops), state)
    code, count, evaluations, rejected = _compiled("exponential").integrate(
        flow.derivatives, clock, stops, state, flow.values, flow.table, jacobian, functions, pair, steps.accuracy,
        steps.adaptive, every, times, states,
    )  # fmt: skip
    status = Status(code)
    jump = status == Status.STEP_TOO_SMALL
    evaluations += 2 * len(state)
    recorded = flow.recorder.at(times[:count], states[:count], flow.values)
    yield Trajectory(
        times[:count], states[:count], recorded, Status.FULL if jump else status, clock[0], evaluations, rejected
    )
    if jump:
        stop = stops[stops > clock[0]][0]
        over = min(stop, clock[0] + pair / 2**JUMPED) if every else stop
        for piece in dormand_prince(flow, clock[0], over, state, steps, np.array([over])[: not every], every):
            clock[0] = piece.reached
            yield piece
        clock[1] = FIRST_LEVEL


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
    """A compiled module that is the same for all diagrams."""
    source = Path(__file__).with_name(f"{method}.py").read_text(encoding="utf-8")
    return machine_code.load(source)
