"""Blocks that compute the same are one kind: each kind is read and written as code once."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from drake_formation.lowering.emit import Kernel, emit
from drake_formation.lowering.errors import LoweringError
from drake_formation.lowering.expressions import Graph, Leaf, UnsupportedOperationError
from drake_formation.lowering.hoisting import hoist
from drake_formation.lowering.trace import UPDATE, TracedBlock


@dataclass(frozen=True)
class Split:
    """A function in two parts.

    Attributes:
        once: computes what is fixed, or None where nothing is.
        always: computes the rest.
        size: how many numbers the first hands to the second.
    """

    once: Kernel | None
    always: Kernel
    size: int


@dataclass(frozen=True)
class Kind:
    """A function that some blocks have in common, as expressions of the numbers they read.

    Attributes:
        graph: the expressions' nodes.
        roots: the nodes of its values.
        inputs: number of input ports of such a block.
        function: the output port that computes it, ``DERIVATIVES`` or ``UPDATE``.
    """

    graph: Graph
    roots: list[int]
    inputs: int
    function: int

    @cached_property
    def leaves(self) -> set[Leaf]:
        """Every number it reads."""
        numbers = {number for root in self.roots for number in self.graph.leaves(root)}
        return {content for number in numbers if isinstance(content := self.graph.nodes[number].content, Leaf)}

    @cached_property
    def ports(self) -> list[int]:
        """The input ports it depends on."""
        return sorted({leaf.group for leaf in self.leaves if leaf.space == "input"})

    @cached_property
    def copied(self) -> Leaf | None:
        """The first of the numbers in a row that it merely passes on, or None where it computes."""
        contents = [self.graph.nodes[root].content for root in self.roots]
        if not contents or not isinstance(contents[0], Leaf) or contents[0].space == "time":
            return None
        first = contents[0]
        in_a_row = [Leaf(first.space, first.group, first.offset + k) for k in range(len(contents))]
        return first if contents == in_a_row else None

    @cached_property
    def kernel(self) -> Kernel:
        """Its source as a whole."""
        return emit(self.graph, self.roots, self.inputs)

    def split(self, fixed_ports: frozenset[int]) -> Split:
        """Its source in two parts: what is computed once, and what in every step."""
        if fixed_ports not in self._splits:
            once, always = hoist(self.graph, self.roots, fixed_ports, self.function)
            self._splits[fixed_ports] = Split(
                emit(self.graph, once, self.inputs) if once else None, emit(self.graph, always, self.inputs), len(once)
            )
        return self._splits[fixed_ports]

    @cached_property
    def _splits(self) -> dict[frozenset[int], Split]:
        return {}


class KindTable:
    """The kinds found so far.

    Every block is traced, for what it computes may depend on attributes that Drake does not know; comparing its
    expressions with a kind's is quick, and reading them is done once a kind. A block may spare itself the trace by an
    attribute ``kind``: blocks of one class whose ``kind`` is equal promise to compute the same of the inputs, state
    and parameters that they read, and to declare the same events.
    """

    def __init__(self) -> None:
        self._traced: dict[Any, list[tuple[list[Any], Kind]]] = {}
        self._promised: dict[Any, Kind] = {}
        self._quiet: set[Any] = set()

    def require_known_events(self, block: TracedBlock) -> None:
        """Refuse a block of Python's whose events a compiled run would leave out.

        Raises:
            LoweringError: it has such events, or they cannot be known.
        """
        promise = getattr(block.block, "kind", None)
        family = (promise, type(block.block), block.sizes)
        if promise is None or family not in self._quiet:
            block.require_known_events()
            self._quiet.add(family)

    def find(self, block: TracedBlock, function: int) -> Kind:
        """The kind of a block's output port, time derivatives or update.

        Raises:
            LoweringError: the block cannot be traced, or does what cannot be compiled.
        """
        promise = getattr(block.block, "kind", None)
        family = (type(block.block), block.sizes, function)
        if promise is None:
            return self._trace(block, function, family)
        if (promise, *family) not in self._promised:
            self._promised[promise, *family] = self._trace(block, function, family)
        return self._promised[promise, *family]

    def _trace(self, block: TracedBlock, function: int, family: Any) -> Kind:
        expressions = block.trace(function)
        if function == UPDATE and not _alike(expressions, block.trace(function)):
            raise LoweringError(block.path, "its update is not the same twice")
        known = self._traced.setdefault(family, [])
        for others, kind in known:
            if _alike(others, expressions):
                return kind
        graph = Graph(block.symbols.leaf_of)
        try:
            kind = Kind(graph, [graph.read(expression) for expression in expressions], len(block.sizes[0]), function)
        except (UnsupportedOperationError, KeyError) as error:
            raise LoweringError(block.path, f"it uses {error}, which has no compiled counterpart") from error
        known.append((expressions, kind))
        return kind


def _alike(some: list[Any], others: list[Any]) -> bool:
    return all(a.EqualTo(b) for a, b in zip(some, others, strict=True))
