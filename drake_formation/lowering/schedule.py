"""Where every number lives in memory, and in which order the kernels run over it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.lowering.declared import is_pythons
from drake_formation.lowering.emit import Kernel
from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.expressions import Leaf
from drake_formation.lowering.hoisting import HOISTED, is_fixed
from drake_formation.lowering.kinds import Kind, KindTable
from drake_formation.lowering.law_kernels import PLACING, law_kernel
from drake_formation.lowering.trace import DERIVATIVES, UPDATE, SymbolTable, TracedBlock
from drake_formation.lowering.wiring import Port, Wiring
from drake_formation.systems.sampled_law import SampledLaw

Table = NDArray[np.uint32]
Task = tuple[int, Kernel, list[int]] | None
"""A level, a kernel and the kernel's row for one block; None where there is nothing to do."""


@dataclass(frozen=True)
class Job:
    """A kind to be computed for one block once everything it reads is there, which is so at its level.

    Attributes:
        fixed_ports: input ports that do not change between two updates of the diagram.
        fixed: whether the result does not change either.
    """

    block: Any
    kind: Kind
    level: int
    address: int
    fixed_ports: frozenset[int]
    fixed: bool


@dataclass(frozen=True)
class Program:
    """Kernels in the order in which they run, and the table of addresses that they read.

    Attributes:
        once: source of the kernels that write what is fixed into the memory.
        outputs: source of the kernels that write outputs into the memory.
        last: source of the kernels that run last: those that write time derivatives, or those of updates.
        ticks: of an update, which of the ticks each of the last kernels belongs to.
        table: for each kernel the address of its list of rows and their number; then the lists; then the rows.
    """

    once: list[str]
    outputs: list[str]
    last: list[str]
    ticks: list[int]
    table: Table


@dataclass(frozen=True)
class Update:
    """How the discrete state of a block is updated.

    Attributes:
        task: writes the new state aside.
        sources: what the update reads.
        aside: where the new state is written.
        place: where the state is.
        size: how many numbers it has.
    """

    task: Task
    sources: list[Job]
    aside: int
    place: int
    size: int


class Layout:
    """The memory of a diagram: one array that holds everything a block reads.

    First the continuous state, in Drake's order; then each block's discrete state, numeric parameters and free inputs
    (those that no block feeds); then the outputs that have been asked for, and what is computed once for them.

    Args:
        wiring: the blocks and their connections.
        state: address of each block's continuous state.

    Attributes:
        size: length of the memory.
        groups: address of every group of numbers: (block, ``state``, 0), (block, ``discrete``, k), (block,
            ``parameter``, k), (block, ``input``, port) of the free inputs and (block, ``hoisted``, function).
        used_inputs: the free inputs that something asked for depends on.
    """

    def __init__(self, wiring: Wiring, state: dict[Any, int]) -> None:
        self._wiring = wiring
        self._kinds = KindTable()
        symbols = SymbolTable()
        self.blocks = {block: TracedBlock(path, block, symbols) for path, block in wiring.blocks.items()}
        self.size = sum(traced.sizes[1] for traced in self.blocks.values())
        self.groups: dict[tuple[Any, str, int], int] = {(block, "state", 0): at for block, at in state.items()}
        self.used_inputs: set[tuple[Any, int]] = set()
        for block, traced in self.blocks.items():
            inputs, _, discrete, parameters = traced.sizes
            for space, sizes in (("discrete", discrete), ("parameter", parameters), ("input", inputs)):
                for group, size in enumerate(sizes):
                    if size >= 0 and (space != "input" or not wiring.source(block, group)):
                        self.groups[block, space, group] = self._allocate(size)
        self._outputs: dict[Any, Job | None] = {}
        for block, traced in self.blocks.items():
            if is_pythons(block):
                self._kinds.require_known_events(traced)

    def address(self, block: Any, port: int) -> int:
        """Address of an output port of a block."""
        return self._output(block, port).address

    def width(self, block: Any, group: int) -> int:
        """Size of a group of a block's discrete state."""
        return self.blocks[block].sizes[2][group]

    def derivatives(self) -> Program:
        """What computes the time derivatives of all continuous state."""
        jobs = []
        for block, traced in self.blocks.items():
            if traced.sizes[1]:
                kind = self._kinds.find(traced, DERIVATIVES)
                jobs.append(self._job(block, kind, self.groups[block, "state", 0]))
        return self._program(self._needed(jobs), jobs)

    def can_update(self, block: Any) -> bool:
        """Whether the update of a block can be compiled: it has a law of plain arrays, or can be traced."""
        if getattr(block, "sampled_law", None) is not None:
            return True
        try:
            self._kinds.find(self.blocks[block], UPDATE)
        except LoweringError:
            return False
        return True

    def updates(self, due: Sequence[Sequence[Any]]) -> Program:
        """What carries out updates: first aside, for all see what was there before, and then puts them in place.

        Args:
            due: for each of the ticks the blocks that are updated then.
        """
        carried, placed, read = [], [], []
        for blocks in due:
            updates = [self._update(block) for block in blocks]
            carried.append(_Steps([update.task for update in updates]))
            placed.append(_Steps([(0, PLACING, [update.aside, update.place, update.size]) for update in updates]))
            read += [job for update in updates for job in update.sources]
        needed = {id(job): job for job in [*read, *self._needed(read)] if not job.kind.copied}
        return self._program(list(needed.values()), [], [*carried, *placed])

    def _update(self, block: Any) -> Update:
        """How a block is updated: by its law of plain arrays, or as traced."""
        traced = self.blocks[block]
        size, place = sum(traced.sizes[2]), self.groups[block, "discrete", 0]
        aside = self._allocate(size)
        law: SampledLaw | None = getattr(block, "sampled_law", None)
        if law is None:
            job = self._job(block, self._kinds.find(traced, UPDATE), aside)
            return Update(self._task(job, job.kind.kernel, aside), self._sources(block, job.kind), aside, place, size)
        inputs, _, _, parameters = traced.sizes
        sources = [self._output(*source) for port in range(len(inputs)) if (source := self._wiring.source(block, port))]
        self.used_inputs |= {(block, port) for port in range(len(inputs)) if (block, "input", port) in self.groups}
        gathered, numbers = self._allocate(sum(inputs)), self.groups.get((block, "parameter", 0), 0)
        row = [aside, place, size, numbers, sum(parameters), gathered]
        for port, width in enumerate(inputs):
            row += [self._leaf_address(block, Leaf("input", port, 0)), width]
        return Update((0, law_kernel(law, len(inputs)), row), sources, aside, place, size)

    def outputs(self, ports: Iterable[Port]) -> Program:
        """What computes some output ports."""
        jobs = [self._output(block, port) for block, port in ports]
        return self._program(self._needed(jobs) + [job for job in jobs if not job.kind.copied], [])

    def _output(self, block: Any, port: int) -> Job:
        """The job of an output port; its address is that of its source where it merely passes numbers on."""
        key = (block, port)
        if key not in self._outputs:
            self._outputs[key] = None
            kind = self._kinds.find(self.blocks[block], port)
            self._level(block, kind)  # what it reads comes first in the memory
            address = self._leaf_address(block, kind.copied) if kind.copied else self._allocate(len(kind.roots))
            self._outputs[key] = self._job(block, kind, address)
        job = self._outputs[key]
        if job is None:
            raise LoweringError(self.blocks[block].path, "it is part of an algebraic loop")
        return job

    def _job(self, block: Any, kind: Kind, address: int) -> Job:
        sources = {port: self._wiring.source(block, port) for port in kind.ports}
        fixed_ports = frozenset(port for port, source in sources.items() if not source or self._output(*source).fixed)
        fixed = kind.function != DERIVATIVES and all(is_fixed(leaf, fixed_ports) for leaf in kind.leaves)
        return Job(block, kind, self._level(block, kind), address, fixed_ports, fixed)

    def _sources(self, block: Any, kind: Kind) -> list[Job]:
        sources = [self._wiring.source(block, port) for port in kind.ports]
        return [self._output(*source) for source in sources if source]

    def _level(self, block: Any, kind: Kind) -> int:
        """The level at which everything is there that a kind reads, from 0."""
        self.used_inputs |= {(block, port) for port in kind.ports if (block, "input", port) in self.groups}
        return max((job.level + (not job.kind.copied) for job in self._sources(block, kind)), default=0)

    @property
    def wires(self) -> list[tuple[Any, int, Any, int]]:
        """Input ports that are fed by output ports: block, port, source, its port."""
        found = []
        for block, traced in self.blocks.items():
            for port, size in enumerate(traced.sizes[0]):
                if size >= 0 and (source := self._wiring.source(block, port)):
                    found.append((block, port, *source))
        return found

    def _leaf_address(self, block: Any, leaf: Leaf) -> int:
        source = self._wiring.source(block, leaf.group) if leaf.space == "input" else None
        start = self.address(*source) if source else self.groups[block, leaf.space, leaf.group]
        return start + leaf.offset

    def _needed(self, jobs: list[Job]) -> list[Job]:
        """Every job that computes something which the given ones read."""
        needed: dict[int, Job] = {}
        waiting = list(jobs)
        while waiting:
            job = waiting.pop()
            for source in self._sources(job.block, job.kind):
                if id(source) not in needed:
                    needed[id(source)] = source
                    waiting.append(source)
        return [job for job in needed.values() if not job.kind.copied]

    def _program(self, outputs: list[Job], derivatives: list[Job], updates: "Sequence[_Steps]" = ()) -> Program:
        """Outputs, then derivatives or updates; of these the steps of all ticks one way and then the other."""
        unique = list({id(job): job for job in outputs}.values())
        once = _Steps([*(self._once(job) for job in [*unique, *derivatives])])
        always = _Steps([self._always(job) for job in unique if not job.fixed])
        last = updates or [_Steps([self._always(job) for job in derivatives])]
        ticks = len(updates) // 2
        return Program(
            once.bodies,
            always.bodies,
            [body for steps in last for body in steps.bodies],
            [number % ticks for number, steps in enumerate(last) for _ in steps.bodies] if ticks else [],
            _packed([*once.rows, *always.rows, *(rows for steps in last for rows in steps.rows)]),
        )

    def _once(self, job: Job) -> Task:
        """What a job computes once: everything, a part, or nothing."""
        if job.fixed:
            return self._task(job, job.kind.kernel, job.address)
        split = job.kind.split(job.fixed_ports)
        key = (job.block, HOISTED, job.kind.function)
        if split.once and key not in self.groups:
            self.groups[key] = self._allocate(split.size)
        return self._task(job, split.once, self.groups[key]) if split.once else None

    def _always(self, job: Job) -> Task:
        return self._task(job, job.kind.split(job.fixed_ports).always, job.address)

    def _task(self, job: Job, kernel: Kernel, address: int) -> Task:
        groups = [self.groups[(job.block, *group)] for group in kernel.groups]
        ports = job.kind.ports
        inputs = [
            self._leaf_address(job.block, Leaf("input", port, 0)) if port in ports else 0
            for port in range(max(ports, default=-1) + 1)
        ]
        return job.level, kernel, [address, *groups, *kernel.turns, *inputs]

    def _allocate(self, size: int) -> int:
        self.size += size
        return self.size - size


class _Steps:
    """Tasks in order: those of one level and of one kernel run one after the other, in one step.

    Attributes:
        bodies: source of the kernel of each step.
        rows: rows of each step.
    """

    def __init__(self, tasks: list[Task]) -> None:
        steps: dict[tuple[int, str], list[tuple[Kernel, list[int]]]] = {}
        known = [task for task in tasks if task]
        for level, kernel, row in sorted(known, key=lambda task: (task[0], task[1].body)):
            steps.setdefault((level, kernel.body), []).append((kernel, row))
        self.bodies = [_body({kernel.turns: kernel for kernel, _ in step}) for step in steps.values()]
        self.rows = [[row for _, row in step] for step in steps.values()]


def _body(kernels: dict[tuple[int, ...], Kernel]) -> str:
    """Source of a step; its loops' lengths stand in the code where they are the same for all blocks."""
    if len(kernels) > 1:
        return next(iter(kernels.values())).body
    ((turns, kernel),) = kernels.items()
    return kernel.body_with(turns)


def _packed(steps: list[list[list[int]]]) -> Table:
    head: list[int] = []
    lists: list[int] = []
    rows: list[int] = []
    lists_at = 2 * len(steps)
    rows_at = lists_at + sum(len(step) for step in steps)
    for step in steps:
        head += [lists_at + len(lists), len(step)]
        for row in step:
            lists.append(rows_at + len(rows))
            rows += row
    return np.array([*head, *lists, *rows], dtype=np.uint32)
