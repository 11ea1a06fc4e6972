"""A diagram as compiled code: its time derivatives, its outputs, its trajectories."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Context, Diagram

from drake_formation import machine_code
from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.events import Updates
from drake_formation.lowering.hoisting import HOISTED
from drake_formation.lowering.integration import (
    METHODS,
    Events,
    Flow,
    Recorder,
    Status,
    Steps,
    Trajectory,
    no_outputs,
    through_events,
)
from drake_formation.lowering.logs import Logs
from drake_formation.lowering.schedule import Layout
from drake_formation.lowering.source import derivatives_source, outputs_source, update_source
from drake_formation.lowering.wiring import Port, Wiring
from drake_formation.systems.templates import CONVERTING

Array = NDArray[np.float64]

EVERY_STEP = np.zeros(0)
RARE = 100.0
"""Updates that lie farther apart (s) are not compiled."""


class CompiledDiagram:
    """What :func:`lower` makes of a diagram.

    Numbers that change from run to run (numeric parameters, discrete state, fixed inputs) are not part of the code but
    of ``values``, an array that :meth:`read` takes from a Context; it is scratch memory too, one thread's own.
    """

    def __init__(self, diagram: Diagram) -> None:
        wiring = Wiring(diagram)
        self.diagram = diagram
        self.updates = Updates(wiring)
        self.logs = Logs(wiring.blocks)
        self._wiring = wiring
        self._layout = Layout(wiring, _state_addresses(diagram, wiring))
        program = self._layout.derivatives()
        self._table = program.table
        code = machine_code.load(derivatives_source(program))
        self._prepare: Callable[..., None] = code.prepare
        self._derivatives: Callable[..., None] = code.derivatives
        self._groups_of: dict[Any, list[tuple[str, int, int]]] = {block: [] for block in wiring.blocks.values()}
        for (block, space, group), address in self._layout.groups.items():
            if space not in ("state", HOISTED):
                self._groups_of[block].append((space, group, address))
        self._recorders: dict[tuple[str, ...], Recorder] = {}
        self._events = self._compiled_events()

    def _compiled_events(self) -> Events | None:
        """The updates that are carried out in compiled code; None where there are none.

        Of ticks that are rare all are left to Drake, which is quicker than compiling; so are those of blocks that
        Drake's symbols cannot follow. Logs of every step need the whole Context at every step.
        """
        if self.logs.every_step:
            return None
        due = {
            ticks: blocks
            for ticks, blocks in self.updates.ticks.items()
            if ticks.period < RARE and all(self._layout.can_update(block) for block in blocks)
        }
        if not due:
            return None
        program = self._layout.updates(list(due.values()))
        code = machine_code.load(update_source(program))
        self._updated = [block for blocks in due.values() for block in blocks]
        return Events(list(due), self._prepare, code.update, program.table)

    def read(self, context: Context, *, wired: bool = False) -> Array:
        """Values of a Context of the diagram: its parameters, discrete state and inputs, and what follows from them.

        Args:
            context: a Context of the diagram.
            wired: it is known that no connected input port has a fixed value in the Context, which takes some time to
                find out.

        Raises:
            ValueError: an input that is needed has no value.
            LoweringError: a connected input port has a fixed value, which Drake lets take the connection's place.
        """
        if not wired:
            self._require_wired(context)
        values = np.zeros(self._layout.size)
        for block, path in ((block, path) for path, block in self._wiring.blocks.items()):
            own = block.GetMyContextFromRoot(context)
            for space, group, address in self._groups_of[block]:
                if space == "parameter":
                    found = own.get_numeric_parameter(group).CopyToVector()
                elif space == "discrete":
                    found = own.get_discrete_state().get_vector(group).CopyToVector()
                elif block.get_input_port(group).HasValue(own):
                    found = block.get_input_port(group).Eval(own)
                elif (block, group) in self._layout.used_inputs:
                    raise ValueError(f"input {block.get_input_port(group).get_name()!r} of block {path!r} has no value")
                else:
                    continue
                values[address : address + len(found)] = found
        self._prepare(values, self._table)
        return values

    def _require_wired(self, context: Context) -> None:
        """Refuse fixed values on connected ports: what such a port gives is not what its source gives, but a copy."""
        for block, port, source, output in self._layout.wires:
            given = _evaluated(source.get_output_port(output), source.GetMyContextFromRoot(context))
            taken = _evaluated(block.get_input_port(port), block.GetMyContextFromRoot(context))
            if taken is not given:
                name, path = block.get_input_port(port).get_name(), self._layout.blocks[block].path
                raise LoweringError(
                    path, f"its input port {name!r} is connected, and has a fixed value in this Context"
                )

    def derivatives(self, time: float, state: Array, values: Array) -> Array:
        """Time derivatives of the continuous state.

        Args:
            time: time (s).
            state: continuous state in Drake's order, shape (states,).
            values: from :meth:`read`.
        """
        result = np.empty(len(state))
        self._derivatives(float(time), np.ascontiguousarray(state, dtype=float), values, self._table, result)
        return result

    def outputs(self, names: Sequence[str], times: Array, states: Array, values: Array) -> dict[str, Array]:
        """Output ports of the diagram along a trajectory, each of shape (samples, size).

        Args:
            names: names of vector-valued output ports.
            times: times (s), shape (samples,).
            states: continuous state at those times, shape (samples, states).
            values: from :meth:`read`.

        Raises:
            LoweringError: a port depends on a block that cannot be compiled.
        """
        recorder = self._recorder(tuple(names))
        memory = np.zeros(self._layout.size)
        memory[: len(values)] = values
        return self.named(names, recorder.at(times, states, memory))

    def named(self, names: Sequence[str], recorded: Array) -> dict[str, Array]:
        """What was recorded, by the names of the ports."""
        sizes = [self.diagram.GetOutputPort(name).size() for name in names]
        parts = np.split(recorded, np.cumsum(sizes)[:-1], axis=1)
        return dict(zip(names, parts, strict=True)) if names else {}

    def integrate(
        self,
        context: Context,
        end: float,
        *,
        method: str = "dormand_prince",
        accuracy: float = 1e-6,
        max_step: float = 0.1,
        adaptive: bool = True,
        at: Array = EVERY_STEP,
        record: Sequence[str] = (),
        updated: bool = False,
        wired: bool = False,
    ) -> Iterator[Trajectory]:
        """Integrate from a Context's time and state, which go along, to the end or to what stops it.

        The diagram's updates are carried out at their times, those at the start included, those at the end not. Its
        logs record at theirs, the start and the end included; those of every step record every sample.

        Args:
            context: a Context of the diagram.
            end: when to stop (s).
            method: ``dormand_prince``, or ``exponential``, which takes far longer steps where the diagram is stiff but
                nearly linear; see :mod:`drake_formation.lowering.integration`.
            accuracy: largest error of any state in one step.
            max_step: largest step (s).
            adaptive: control the step; else every step is the largest.
            at: times to sample at (s), rising, from the Context's time to the end; where empty every accepted step is a
                sample. At the time of an update the sample is taken after it, at the end before it.
            record: names of vector-valued output ports of the diagram, which every sample holds one after the other.
            updated: whether the updates due at the start have been carried out.
            wired: as for :meth:`read`.

        Yields:
            The trajectory in pieces, the last of which is ``DONE`` or says why there are no more; where its status is
            ``NOT_FINITE``, the Context holds the state that is not.

        Raises:
            ValueError: there is no such method, or the times do not rise or are not within the integration.
            LoweringError: as for :meth:`read` and :meth:`outputs`.
        """
        if method not in METHODS:
            raise ValueError(f"no method {method!r}; there are {', '.join(METHODS)}")
        if len(at) and not ((np.diff(at) > 0).all() and context.get_time() <= at[0] and at[-1] <= end):
            raise ValueError(f"times to sample at must rise from {context.get_time():g} s to {end:g} s at most")
        steps = Steps(accuracy, max_step, adaptive)
        state = context.get_continuous_state_vector().CopyToVector()
        if not wired:
            self._require_wired(context)
        self.logs.record_step(context)
        self.logs.record_due(context)
        events = self._events if method == "dormand_prince" else None
        here = events.ticks if events else ()
        recorder = self._recorder(tuple(record))
        while (begin := context.get_time()) < end:
            if not updated and (not events or self.updates.due(begin, here)):
                self.updates.carry_out(context)
                updated = True
            flow = Flow(self._derivatives, self._table, self.read(context, wired=True), recorder)
            stop = self.logs.after(begin, self.updates.after(begin, end, here))
            wanted, every = at[(at >= begin) & ((at < stop) | (stop == end) & (at <= end))], not len(at)
            if events:
                pieces = through_events(flow, events, begin, stop, state, steps, wanted, every, updated)
            else:
                pieces = METHODS[method](flow, begin, stop, state, steps, wanted, every)
            updated = False
            for piece in pieces:
                for time, sample in zip(piece.times, piece.states, strict=True) if self.logs.every_step else ():
                    context.SetTimeAndContinuousState(time, sample)
                    self.logs.record_step(context)
                context.SetTimeAndContinuousState(piece.reached, state)
                if events:
                    self._write_discrete(context, flow.values)
                self.logs.record_due(context)
                done = piece.status == Status.DONE
                yield replace(piece, status=Status.FULL) if done and stop < end else piece
            if not done:
                return

    def _write_discrete(self, context: Context, values: Array) -> None:
        """Write the discrete state of the blocks that compiled code updates into a Context."""
        for block in self._updated:
            own = block.GetMyMutableContextFromRoot(context)
            for space, group, address in self._groups_of[block]:
                if space == "discrete":
                    own.SetDiscreteState(group, values[address : address + self._layout.width(block, group)])

    def _recorder(self, names: tuple[str, ...]) -> Recorder:
        if not names:
            return Recorder(no_outputs(), self._table, np.zeros(0, dtype=np.uint32))
        with CONVERTING:
            return self._known_recorder(names)

    def _known_recorder(self, names: tuple[str, ...]) -> Recorder:
        if names not in self._recorders:
            ports = [self.diagram.GetOutputPort(name) for name in names]
            sources: list[Port] = [self._wiring.leaf(self.diagram, int(port.get_index())) for port in ports]
            program = self._layout.outputs(sources)
            addresses = [
                address + k
                for source, port in zip(sources, ports, strict=True)
                for address in [self._layout.address(*source)]
                for k in range(port.size())
            ]
            code = machine_code.load(outputs_source(program)).outputs
            self._recorders[names] = Recorder(code, program.table, np.array(addresses, dtype=np.uint32))
        return self._recorders[names]


def lower(diagram: Diagram) -> CompiledDiagram:
    """Compile a diagram.

    Its blocks are traced with Drake's symbolic scalar, so they must convert to it; each kind of block becomes one
    compiled function that runs over all its blocks. The code is kept on disk:
    see :mod:`drake_formation.machine_code`.

    What a compiled run does is what Drake's Simulator does, with one difference: every periodic update is carried out,
    also where Drake misses one by rounding (see :mod:`drake_formation.lowering.ticks`). What it would leave out is
    refused: abstract state and parameters, witness functions, events of each step or of the initialization,
    unrestricted updates, publishing by blocks that are not Drake's logs. Blocks of Python's must be templates over
    Drake's scalars, even where nothing depends on them, for only their conversion tells which events they have.

    Args:
        diagram: any Drake diagram of continuous blocks and of blocks with one periodic discrete update.

    Several threads may do so at once; they take turns. A compiled diagram is one thread's own, as its Contexts are.

    Raises:
        LoweringError: a block cannot be compiled; it is named.
    """
    with CONVERTING:
        return CompiledDiagram(diagram)


def _evaluated(port: Any, context: Context) -> Any:
    """The very value of a port; None where something before it is missing."""
    try:
        return port.EvalAbstract(context)
    except RuntimeError:
        return None


def _state_addresses(diagram: Diagram, wiring: Wiring) -> dict[Any, int]:
    """Where each block's continuous state begins in the diagram's."""
    context = diagram.CreateDefaultContext()
    context.SetContinuousState(np.arange(float(context.num_continuous_states())))
    addresses = {}
    for path, block in wiring.blocks.items():
        own = block.GetMyContextFromRoot(context).get_continuous_state_vector().CopyToVector()
        if len(own):
            if not np.array_equal(own, own[0] + np.arange(len(own))):
                raise LoweringError(path, "its state is not in one piece in the diagram's")
            addresses[block] = int(own[0])
    return addresses
