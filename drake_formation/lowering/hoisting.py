"""What does not change during an integration is computed once, when the numbers are read, and not in every step.

Numeric parameters, discrete state and inputs from outside stay as they are between two updates, and so does what
follows from them alone: the rest length of a spring, the inverse of a mass.
"""

from collections.abc import Collection, Iterable

from drake_formation.lowering.expressions import CONNECTIVES, RELATIONS, Graph, Leaf, Node

CHANGING = ("state", "time")
"""What changes in every step."""
FORMULAS = {*RELATIONS, *CONNECTIVES}
"""What is true or false is no number that could be kept."""
HOISTED = "hoisted"
"""The space of what was computed once; its groups belong to one function of a block each."""


def is_fixed(leaf: Leaf, fixed_ports: Collection[int]) -> bool:
    """Whether a number stays as it is between two updates."""
    return leaf.group in fixed_ports if leaf.space == "input" else leaf.space not in CHANGING


class Hoister:
    """Rewrites nodes so that they read what is fixed as one number, and keeps what must be computed for that.

    Args:
        graph: the graph, which grows.
        fixed_ports: input ports whose numbers are fixed.
        group: group of the numbers in the space ``HOISTED``.

    Attributes:
        hoisted: the nodes to compute once, in the order of their offsets.
    """

    def __init__(self, graph: Graph, fixed_ports: Collection[int], group: int) -> None:
        self.hoisted: list[int] = []
        self._graph = graph
        self._fixed_ports = fixed_ports
        self._group = group
        self._fixed: dict[int, bool] = {}
        self._rewritten: dict[int, int] = {}

    def rewrite(self, number: int) -> int:
        """Number of a node that computes the same."""
        if number not in self._rewritten:
            self._rewritten[number] = self._hoist(number) if self._is_fixed(number) else self._opened(number)
        return self._rewritten[number]

    def _opened(self, number: int) -> int:
        """A node that changes: what is fixed in it is taken together and hoisted."""
        node = self._graph.nodes[number]
        arguments = list(node.arguments)
        if node.operation in ("Add", "Mul"):
            arguments = self._gathered(node)
        elif node.operation == "Div" and self._is_fixed(arguments[1]):
            inverse = self._graph.add("Div", [self._graph.constant(1.0), arguments[1]])
            return self._graph.add("Mul", [self.rewrite(arguments[0]), self.rewrite(inverse)])
        if not arguments:
            return number
        return self._graph.add(node.operation, [self.rewrite(argument) for argument in arguments], node.content)

    def _gathered(self, node: Node) -> list[int]:
        fixed = [argument for argument in node.arguments if self._is_fixed(argument)]
        if len(fixed) < 2:
            return list(node.arguments)
        rest = [argument for argument in node.arguments if not self._is_fixed(argument)]
        return [*rest, self._graph.add(node.operation, fixed)]

    def _hoist(self, number: int) -> int:
        """A fixed node as a number of the space ``HOISTED``, unless reading it is no cheaper than computing it."""
        node = self._graph.nodes[number]
        if node.operation in FORMULAS:
            return self._opened(number)
        computed = [k for k in node.arguments if self._graph.nodes[k].arguments]
        if not node.arguments or (node.operation == "Neg" and not computed):
            return number
        self.hoisted.append(number)
        return self._graph.add("leaf", content=Leaf(HOISTED, self._group, len(self.hoisted) - 1))

    def _is_fixed(self, number: int) -> bool:
        if number not in self._fixed:
            node = self._graph.nodes[number]
            if isinstance(node.content, Leaf):
                self._fixed[number] = is_fixed(node.content, self._fixed_ports)
            else:
                self._fixed[number] = all(self._is_fixed(argument) for argument in node.arguments)
        return self._fixed[number]


def hoist(graph: Graph, roots: Iterable[int], fixed_ports: Collection[int], group: int) -> tuple[list[int], list[int]]:
    """Split nodes into what is computed once and what is computed in every step.

    Args:
        graph: the graph, which grows.
        roots: the nodes.
        fixed_ports: input ports whose numbers are fixed.
        group: group of the numbers in the space ``HOISTED``.

    Returns:
        The nodes to compute once, in the order of their offsets, and the roots that read them.
    """
    hoister = Hoister(graph, fixed_ports, group)
    rewritten = [hoister.rewrite(root) for root in roots]
    return hoister.hoisted, rewritten
