"""A diagram as compiled code: its time derivatives, its outputs, its trajectories."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydrake.systems.framework import Context, Diagram

from drake_formation.lowering import cache
from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.events import Updates
from drake_formation.lowering.hoisting import HOISTED
from drake_formation.lowering.integration import METHODS, Flow, Status, Steps, Trajectory
from drake_formation.lowering.logs import Logs
from drake_formation.lowering.schedule import Layout, Table
from drake_formation.lowering.source import derivatives_source, outputs_source
from drake_formation.lowering.wiring import Port, Wiring
from drake_formation.systems.templates import CONVERTING

Array = NDArray[np.float64]

EVERY_STEP = np.zeros(0)


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
        code = cache.load(derivatives_source(program))
        self._prepare: Callable[..., None] = code.prepare
        self._derivatives: Callable[..., None] = code.derivatives
        self._groups_of: dict[Any, list[tuple[str, int, int]]] = {block: [] for block in wiring.blocks.values()}
        for (block, space, group), address in self._layout.groups.items():
            if space not in ("state", HOISTED):
                self._groups_of[block].append((space, group, address))
        self._outputs: dict[tuple[str, ...], tuple[Callable[..., None], Table, Table]] = {}

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
        code, table, addresses = self._compiled_outputs(tuple(names))
        memory = np.zeros(self._layout.size)
        memory[: len(values)] = values
        result = np.empty((len(times), len(addresses)))
        code(np.ascontiguousarray(times), np.ascontiguousarray(states), memory, table, addresses, result)
        sizes = [self.diagram.GetOutputPort(name).size() for name in names]
        parts = np.split(result, np.cumsum(sizes)[:-1], axis=1)
        return dict(zip(names, parts, strict=True))

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
            updated: whether the updates due at the start have been carried out.
            wired: as for :meth:`read`.

        Yields:
            The trajectory in pieces, the last of which is ``DONE`` or says why there are no more; where its status is
            ``NOT_FINITE``, the Context holds the state that is not.

        Raises:
            ValueError: there is no such method, or the times do not rise or are not within the integration.
            LoweringError: as for :meth:`read`.
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
        while (begin := context.get_time()) < end:
            if not updated:
                self.updates.carry_out(context)
            updated = False
            flow = Flow(self._derivatives, self._table, self.read(context, wired=True))
            stop = self.logs.after(begin, self.updates.after(begin, end))
            wanted = at[(at >= begin) & ((at < stop) | (stop == end) & (at <= end))]
            for piece in METHODS[method](flow, begin, stop, state, steps, wanted, not len(at)):
                for time, sample in zip(piece.times, piece.states, strict=True) if self.logs.every_step else ():
                    context.SetTimeAndContinuousState(time, sample)
                    self.logs.record_step(context)
                context.SetTimeAndContinuousState(piece.reached, state)
                self.logs.record_due(context)
                done = piece.status == Status.DONE
                yield replace(piece, status=Status.FULL) if done and stop < end else piece
            if not done:
                return

    def _compiled_outputs(self, names: tuple[str, ...]) -> tuple[Callable[..., None], Table, Table]:
        with CONVERTING:
            return self._known_outputs(names)

    def _known_outputs(self, names: tuple[str, ...]) -> tuple[Callable[..., None], Table, Table]:
        if names not in self._outputs:
            ports = [self.diagram.GetOutputPort(name) for name in names]
            sources: list[Port] = [self._wiring.leaf(self.diagram, int(port.get_index())) for port in ports]
            program = self._layout.outputs(sources)
            addresses = [
                address + k
                for source, port in zip(sources, ports, strict=True)
                for address in [self._layout.address(*source)]
                for k in range(port.size())
            ]
            code = cache.load(outputs_source(program)).outputs
            self._outputs[names] = code, program.table, np.array(addresses, dtype=np.uint32)
        return self._outputs[names]


def lower(diagram: Diagram) -> CompiledDiagram:
    """Compile a diagram.

    Its blocks are traced with Drake's symbolic scalar, so they must convert to it; each kind of block becomes one
    compiled function that runs over all its blocks. The code is kept on disk:
    see :mod:`drake_formation.lowering.cache`.

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
