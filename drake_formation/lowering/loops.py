"""Sums of like terms become loops: what a block with a hundred neighbours computes is as short as one with three.

The terms of such a sum are one expression in which some leaves move, each by the same amount from term to term: to the
next input port, the next parameter. Sums without such a pattern stay as they are.
"""

from typing import NamedTuple

from drake_formation.lowering.expressions import Graph, Leaf, Node, Walk

FEWEST = 3
"""Fewer terms are not worth a loop."""


class Term(NamedTuple):
    """A term of a sum: its form with the leaves left out, and its leaves in the order in which it reads."""

    number: int
    form: object
    leaves: tuple[Leaf, ...]


class Store(NamedTuple):
    """A value to keep at a place, or where ``loop`` is the number of a loop, one in each of its turns.

    In turn k the place is ``place + k step``.
    """

    value: int
    place: int
    step: int = 0
    loop: int | None = None


class LoopFinder:
    """Rewrites nodes of a graph so that sums of like terms become ``Sum`` nodes.

    A ``Sum`` has one argument, the term of turn k in :class:`Walk` leaves, and as content the number of the loop; the
    lengths of the loops are in ``turns``.

    Args:
        graph: the graph, which grows.
    """

    def __init__(self, graph: Graph) -> None:
        self.turns: list[int] = []
        self._graph = graph
        self._rewritten: dict[int, int] = {}

    def rewrite(self, number: int) -> int:
        """Number of a node that computes the same with loops."""
        if number not in self._rewritten:
            node = self._graph.nodes[number]
            if node.operation == "Add" and len(node.arguments) >= FEWEST:
                self._rewritten[number] = self._sum(node)
            else:
                arguments = [self.rewrite(argument) for argument in node.arguments]
                self._rewritten[number] = self._graph.add(node.operation, arguments, node.content)
        return self._rewritten[number]

    def stores(self, roots: list[int]) -> list[Store]:
        """Values to keep one after the other; like ones become a loop too."""
        families: dict[object, list[Term]] = {}
        for place, root in enumerate(roots):
            number, form, leaves = self._term(root)
            families.setdefault(form, []).append(Term(number, form, (Leaf("out", 0, place), *leaves)))
        result = []
        for family in families.values():
            for run in _runs(family):
                place = run[0].leaves[0].offset
                if len(run) < FEWEST:
                    result += [Store(self.rewrite(term.number), term.leaves[0].offset) for term in run]
                else:
                    step = run[1].leaves[0].offset - place
                    result.append(Store(self._turn(run), place, step, self._loop_of(len(run))))
        return result

    def _sum(self, node: Node) -> int:
        families: dict[object, list[Term]] = {}
        for argument in node.arguments:
            term = self._term(argument)
            families.setdefault(term.form, []).append(term)
        terms = []
        for family in families.values():
            for run in _runs(sorted(family, key=lambda term: term.leaves)):
                if len(run) < FEWEST:
                    terms += [self.rewrite(term.number) for term in run]
                else:
                    terms.append(self._loop(run))
        return terms[0] if len(terms) == 1 else self._graph.add("Add", terms)

    def _loop(self, run: list[Term]) -> int:
        return self._graph.add("Sum", [self._turn(run)], float(self._loop_of(len(run))))

    def _loop_of(self, length: int) -> int:
        """Number of the loop of a length."""
        if length not in self.turns:
            self.turns.append(length)
        return self.turns.index(length)

    def _turn(self, run: list[Term]) -> int:
        """What is computed in one turn of a loop over some terms."""
        moving = {
            first: Walk(*first, *_step(first, second))
            for first, second in zip(run[0].leaves, run[1].leaves, strict=True)
            if first != second
        }
        return self._moved(run[0].number, moving, {})

    def _moved(self, number: int, moving: dict[Leaf, Walk], done: dict[int, int]) -> int:
        """Number of a node in which the moving leaves walk; what has none in it is rewritten as usual."""
        if number not in done:
            node = self._graph.nodes[number]
            if isinstance(node.content, Leaf):
                done[number] = self._graph.add("leaf", content=moving.get(node.content, node.content))
            else:
                arguments = [self._moved(argument, moving, done) for argument in node.arguments]
                stays = tuple(arguments) == node.arguments
                done[number] = (
                    self.rewrite(number) if stays else self._graph.add(node.operation, arguments, node.content)
                )
        return done[number]

    def _term(self, number: int) -> Term:
        places: dict[Leaf, int] = {}
        forms: dict[int, object] = {}

        def form(current: int) -> object:
            if current not in forms:
                node = self._graph.nodes[current]
                if isinstance(node.content, Leaf):
                    place = places.setdefault(node.content, len(places))
                    forms[current] = (node.content.space, place)
                else:
                    forms[current] = (node.operation, node.content, *(form(argument) for argument in node.arguments))
            return forms[current]

        return Term(number, form(number), tuple(places))


def _step(first: Leaf, second: Leaf) -> tuple[int, int]:
    return second.group - first.group, second.offset - first.offset


def _steps(first: Term, second: Term) -> list[tuple[int, int]]:
    return [_step(a, b) for a, b in zip(first.leaves, second.leaves, strict=True)]


def _runs(terms: list[Term]) -> list[list[Term]]:
    """Split terms of one form into runs along which every leaf moves in equal steps.

    The space of a parameter or discrete group is one array of memory, that of an input port another: ports may step
    from one to the next, groups of parameters may not.
    """
    runs: list[list[Term]] = []
    for term in terms:
        if runs and _continues(runs[-1], term):
            runs[-1].append(term)
        else:
            runs.append([term])
    return runs


def _continues(run: list[Term], term: Term) -> bool:
    steps = _steps(run[-1], term)
    if any(group and leaf.space != "input" for (group, _), leaf in zip(steps, term.leaves, strict=True)):
        return False
    return len(run) == 1 or steps == _steps(run[0], run[1])
