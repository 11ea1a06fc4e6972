"""Traced expressions as the source of a compiled function over all blocks of a kind."""

import math
from collections import ChainMap
from collections.abc import MutableMapping
from dataclasses import dataclass, field

from drake_formation.lowering.expressions import RELATIONS, Graph, Leaf, Node, Walk
from drake_formation.lowering.loops import LoopFinder, Store

HEAD = "def {name}(t, m, table, step, out):"
"""A kernel reads the time, the memory and its rows of the table, and writes to the memory or the derivatives."""

CALLS = {
    "Abs": "abs",
    "Sqrt": "math.sqrt",
    "Exp": "math.exp",
    "Log": "math.log",
    "Sin": "math.sin",
    "Cos": "math.cos",
    "Tan": "math.tan",
    "Asin": "math.asin",
    "Acos": "math.acos",
    "Atan": "math.atan",
    "Sinh": "math.sinh",
    "Cosh": "math.cosh",
    "Tanh": "math.tanh",
    "Ceil": "np.ceil",
    "Floor": "np.floor",
    "Atan2": "math.atan2",
    "Min": "min",
    "Max": "max",
}
INFIX = {
    **{"Mul": " * ", "Div": " / ", "Pow": " ** ", "And": " and ", "Or": " or "},
    **{name: f" {relation} " for name, relation in RELATIONS.items()},
}
PREFIX = {"Neg": "-", "Not": "not "}


LONGEST_UNROLLED = 16


@dataclass(frozen=True)
class Kernel:
    """The source of a function that computes some expressions for every block of a kind.

    Attributes:
        body: the source without its head, the same for kinds that differ in the number of like ports alone.
        groups: which memory each row points to, in order: (space, group); inputs, one a port, follow these.
        turns: lengths of the loops, which stand in the row after the groups.
        inputs: number of input ports in the row.
    """

    body: str
    groups: tuple[tuple[str, int], ...]
    turns: tuple[int, ...]
    inputs: int

    def body_with(self, turns: tuple[int, ...]) -> str:
        """The source for blocks whose loops all have some lengths; short ones stand in the code, to be unrolled."""
        body = self.body
        for k, length in enumerate(turns):
            if length <= LONGEST_UNROLLED:
                body = body.replace(_length_line(k, len(self.groups)), f"        n{k} = {length}")
        return body


def emit(graph: Graph, roots: list[int], inputs: int) -> Kernel:
    """Write the kernel of some nodes; a row of its table is [output, groups …, loop lengths …, inputs …].

    Args:
        graph: the nodes.
        roots: what to compute, one number after the other.
        inputs: how many input ports the block has.
    """
    finder = LoopFinder(graph)
    return _Writer(graph, finder.stores(roots), finder.turns, inputs).kernel()


def _literal(value: float) -> str:
    text = repr(abs(value)) if math.isfinite(value) else f"math.{abs(value)!r}"
    return text if value >= 0 else f"(-{text})"


def _length_line(loop: int, groups: int) -> str:
    return f"        n{loop} = table[row + {1 + groups + loop}]"


@dataclass
class _Scope:
    """Lines of the function, of one loop or of one branch, and the names of the nodes known there.

    Nodes that do not move with a loop are computed ``around`` it; in a branch the node ``positive`` is so.
    """

    indent: str
    around: "_Scope | None" = None
    positive: int | None = None
    lines: list[str] = field(default_factory=list)
    names: MutableMapping[int, str] = field(default_factory=dict)

    def branch(self, positive: int) -> "_Scope":
        """A scope within this one that knows its names and keeps its own to itself."""
        return _Scope(self.indent + "    ", self.around, positive, names=ChainMap({}, self.names))


class _Writer:
    def __init__(self, graph: Graph, stores: list[Store], turns: list[int], inputs: int) -> None:
        self._graph, self._stores, self._turns, self._inputs = graph, stores, turns, inputs
        self._order = self._reachable()
        leaves = [
            content for n in self._order if (content := graph.nodes[n].content) and not isinstance(content, float)
        ]
        spaces = {(leaf.space, leaf.group) for leaf in leaves if leaf.space not in ("input", "time")}
        self._groups = tuple(sorted(spaces))
        self._outer = _Scope("        ")
        self._named = 0

    def kernel(self) -> Kernel:
        """The whole."""
        count = len(self._groups)
        prologue = [
            "    for block in range(table[step + 1]):",
            "        row = table[table[step] + block]",
            "        o = table[row]",
            *(f"        g{k} = table[row + {1 + k}]" for k in range(count)),
            *(_length_line(k, count) for k in range(len(self._turns))),
        ]
        single = [store for store in self._stores if store.loop is None]
        results = [(store.place, self._value(store.value, self._outer)) for store in single]
        loops = [self._store_loop(loop) for loop in range(len(self._turns))]
        stores = [f"        out[o + {place}] = {value}" for place, value in results]
        body = "\n".join([*prologue, *self._outer.lines, *stores, *(line for loop in loops for line in loop)])
        return Kernel(body, self._groups, tuple(self._turns), self._inputs)

    def _store_loop(self, loop: int) -> list[str]:
        """Lines of the loop that keeps the values of all turns of one length."""
        stores = [store for store in self._stores if store.loop == loop]
        if not stores:
            return []
        inner = _Scope("            ", self._outer)
        values = [self._value(store.value, inner) for store in stores]
        kept = [
            f"            out[o + {_moved(store.place, store.step)}] = {value}"
            for store, value in zip(stores, values, strict=True)
        ]
        return [f"        for k in range(n{loop}):", *inner.lines, *kept]

    def _reachable(self) -> list[int]:
        """Numbers of all nodes that are needed, arguments first."""
        order: dict[int, None] = {}

        def visit(number: int) -> None:
            if number not in order:
                for argument in self._graph.nodes[number].arguments:
                    visit(argument)
                order[number] = None

        for store in self._stores:
            visit(store.value)
        self._walks: set[int] = set()
        self._depth: dict[int, int] = {}
        for number in order:
            node = self._graph.nodes[number]
            if isinstance(node.content, Walk) or (
                node.operation != "Sum" and any(argument in self._walks for argument in node.arguments)
            ):
                self._walks.add(number)
            below = max((self._depth[argument] for argument in node.arguments), default=0)
            self._depth[number] = below + (node.operation == "Sum")
        return list(order)

    def _value(self, number: int, scope: _Scope) -> str:
        """Name or text of a node's value, computed where it belongs: outside the loop unless it moves with it."""
        if number not in self._walks:
            scope = scope.around or scope
        node = self._graph.nodes[number]
        if node.operation == "constant" and isinstance(node.content, float):
            return _literal(node.content)
        if number not in scope.names:
            if node.operation == "Sum":
                self._loop(node.content, self._depth[number])
            else:
                self._assign(number, node, scope)
        return scope.names[number]

    def _assign(self, number: int, node: Node, scope: _Scope) -> None:
        """A name for a node; what is zero unless something is positive is computed only where that is so."""
        self._named += 1
        name = f"{'w' if number in self._walks else 'v'}{self._named}"
        positive = self._positive_factor(node)
        if positive is None or positive == scope.positive:
            text = self._text(node, scope)
            scope.lines.append(f"{scope.indent}{name} = {text}")
        else:
            condition = self._value(positive, scope)
            branch = scope.branch(positive)
            text = self._text(node, branch)
            scope.lines += [
                f"{scope.indent}{name} = 0.0",
                f"{scope.indent}if not {condition} <= 0.0:",  # NaN goes the long way
                *branch.lines,
                f"{branch.indent}{name} = {text}",
            ]
        scope.names[number] = name

    def _positive_factor(self, node: Node) -> int | None:
        """The node p of a product p⁺ a … or a quotient p⁺ a … / b, with p⁺ = max(p, 0)."""
        if node.operation == "Div":
            numerator = self._graph.nodes[node.arguments[0]]
            factors = numerator.arguments if numerator.operation == "Mul" else node.arguments[:1]
        else:
            factors = node.arguments if node.operation == "Mul" else ()
        for factor in factors:
            inner = self._graph.nodes[factor]
            if inner.operation == "Max":
                others = [argument for argument in inner.arguments if self._graph.nodes[argument].content != 0.0]
                return others[0] if len(others) == 1 else None
        return None

    def _loop(self, loop: Leaf | Walk | float | None, depth: int) -> None:
        """All sums of one length that can be computed together, in one loop."""
        sums = [
            number
            for number in self._order
            if (node := self._graph.nodes[number]).operation == "Sum"
            and node.content == loop
            and self._depth[number] == depth
        ]
        assert isinstance(loop, float)
        inner = _Scope("            ", self._outer)
        terms = [self._value(self._graph.nodes[number].arguments[0], inner) for number in sums]
        for number in sums:
            self._named += 1
            self._outer.names[number] = f"s{self._named}"
        names = [self._outer.names[number] for number in sums]
        self._outer.lines += [f"        {name} = 0.0" for name in names]
        self._outer.lines.append(f"        for k in range(n{int(loop)}):")
        self._outer.lines += inner.lines
        self._outer.lines += [f"            {name} += {term}" for name, term in zip(names, terms, strict=True)]

    def _text(self, node: Node, scope: _Scope) -> str:
        if isinstance(node.content, Leaf | Walk):
            return self._address(node.content)
        operation = node.operation
        if operation == "Add":
            return self._sum(node, scope)
        values = [self._value(argument, scope) for argument in node.arguments]
        if operation in INFIX:
            return INFIX[operation].join(values)
        if operation in PREFIX:
            return f"{PREFIX[operation]}{values[0]}"
        if operation == "IfThenElse":
            return f"{values[1]} if {values[0]} else {values[2]}"
        return str(bool(node.content)) if operation == "truth" else f"{CALLS[operation]}({', '.join(values)})"

    def _sum(self, node: Node, scope: _Scope) -> str:
        text = ""
        for argument in node.arguments:
            term = self._graph.nodes[argument]
            if term.operation == "Neg":
                text += (
                    f" - {self._value(term.arguments[0], scope)}"
                    if text
                    else f"-{self._value(term.arguments[0], scope)}"
                )
            else:
                text += f" + {self._value(argument, scope)}" if text else self._value(argument, scope)
        return text

    def _address(self, leaf: Leaf | Walk) -> str:
        if leaf.space == "time":
            return "t"
        index = _moved(leaf.offset, leaf.offset_step) if isinstance(leaf, Walk) else str(leaf.offset)
        if leaf.space != "input":
            return f"m[g{self._groups.index((leaf.space, leaf.group))} + {index}]"
        port = _moved(leaf.group, leaf.group_step) if isinstance(leaf, Walk) else str(leaf.group)
        first = 1 + len(self._groups) + len(self._turns)
        return f"m[table[row + {first} + {port}] + {index}]"


def _moved(start: int, step: int) -> str:
    if step == 0:
        return str(start)
    return f"{start} + {step} * k" if step > 0 else f"{start} - {-step} * k"
