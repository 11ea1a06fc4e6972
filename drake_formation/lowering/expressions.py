"""Drake's symbolic expressions as one graph in which equal subexpressions are one node."""

from collections.abc import Iterable
from typing import Any, NamedTuple

from pydrake.symbolic import ExpressionKind, FormulaKind


class Leaf(NamedTuple):
    """A number that a block reads: ``space`` says from where.

    ``time``; ``input`` (of port ``group``); ``state``; ``discrete`` or ``parameter`` (of that group).
    """

    space: str
    group: int
    offset: int


class Walk(NamedTuple):
    """A leaf that moves through its space in a loop: in turn k it is ``(group + k Δgroup, offset + k Δoffset)``."""

    space: str
    group: int
    offset: int
    group_step: int
    offset_step: int


class Node(NamedTuple):
    """An operation on other nodes, a :class:`Leaf` (or :class:`Walk`), or a constant."""

    operation: str
    arguments: tuple[int, ...] = ()
    content: Leaf | Walk | float | None = None


# Expressions with the same number of arguments, written as Python functions of them.
FUNCTIONS = {
    *("Abs", "Sqrt", "Exp", "Log", "Sin", "Cos", "Tan", "Asin", "Acos", "Atan", "Sinh", "Cosh", "Tanh"),
    *("Ceil", "Floor", "Atan2", "Min", "Max", "Div", "IfThenElse"),
}
RELATIONS = {"Eq": "==", "Neq": "!=", "Gt": ">", "Geq": ">=", "Lt": "<", "Leq": "<="}
CONNECTIVES = {"And": "and", "Or": "or", "Not": "not"}


COMPILED = {"Add", "Mul", "Pow", *FUNCTIONS, *RELATIONS, *CONNECTIVES}


class UnsupportedOperationError(ValueError):
    """An operation that has no compiled counterpart."""


class Graph:
    """Nodes by number; asking twice for the same node gives the same number.

    Args:
        leaf_of: what each of Drake's variables stands for, by its id.
    """

    def __init__(self, leaf_of: dict[int, Leaf]) -> None:
        self.nodes: list[Node] = []
        self._numbers: dict[Node, int] = {}
        self._leaf_of = leaf_of

    def add(self, operation: str, arguments: Iterable[int] = (), content: Leaf | Walk | float | None = None) -> int:
        """Number of a node, which is made if there is none yet."""
        node = Node(operation, tuple(arguments), content)
        if node not in self._numbers:
            self._numbers[node] = len(self.nodes)
            self.nodes.append(node)
        return self._numbers[node]

    def constant(self, value: float) -> int:
        """Number of a constant."""
        return self.add("constant", content=value)

    def read(self, expression: Any) -> int:
        """Number of the node that computes one of Drake's expressions or formulas.

        Raises:
            UnsupportedOperationError: it contains what cannot be compiled.
        """
        if isinstance(expression, float | int):
            return self.constant(float(expression))
        kind = expression.get_kind()
        if kind == ExpressionKind.Constant:
            return self.constant(expression.Evaluate())
        if kind == ExpressionKind.Var:
            (variable,) = expression.GetVariables()
            return self.add("leaf", content=self._leaf_of[variable.get_id()])
        if kind in (FormulaKind.True_, FormulaKind.False_):
            return self.add("truth", content=float(kind == FormulaKind.True_))
        name = kind.name
        if name not in COMPILED:
            raise UnsupportedOperationError(f"{name} in {str(expression)[:80]}")
        arguments = [self.read(argument) for argument in expression.Unapply()[1]]
        special = {"Add": self._sum, "Mul": self._product, "Pow": self._power}.get(name)
        return special(arguments) if special else self.add(name, arguments)

    def _sum(self, terms: list[int]) -> int:
        """Drake writes every sum with a constant first, which is often zero."""
        terms = [term for term in terms if not self._is(term, 0.0)]
        return terms[0] if len(terms) == 1 else self.add("Add", terms)

    def _product(self, factors: list[int]) -> int:
        negative = any(self._is(factor, -1.0) for factor in factors)
        factors = [factor for factor in factors if not self._is(factor, -1.0) and not self._is(factor, 1.0)]
        product = factors[0] if len(factors) == 1 else self.add("Mul", factors)
        return self.add("Neg", [product]) if negative else product

    def _power(self, arguments: list[int]) -> int:
        """Drake knows products and roots as powers; a small integer power is cheaper as a product."""
        base, exponent = arguments
        value = self.nodes[exponent].content
        if self.nodes[exponent].operation == "constant" and isinstance(value, float):
            if value == 0.5:
                return self.add("Sqrt", [base])
            if value.is_integer() and 2 <= abs(value) <= 4:
                power = self.add("Mul", [base] * int(abs(value)))
                return power if value > 0 else self.add("Div", [self.constant(1.0), power])
            if value == -1.0:
                return self.add("Div", [self.constant(1.0), base])
        return self.add("Pow", [base, exponent])

    def _is(self, number: int, value: float) -> bool:
        node = self.nodes[number]
        return node.operation == "constant" and node.content == value

    def leaves(self, number: int) -> list[int]:
        """Leaves of a node in the order in which its expression reads, each once."""
        found: dict[int, None] = {}

        def visit(current: int) -> None:
            node = self.nodes[current]
            if node.operation == "leaf":
                found[current] = None
            for argument in node.arguments:
                visit(argument)

        visit(number)
        return list(found)
