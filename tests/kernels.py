"""Emitted kernels, run as plain Python on the numbers of a block, and expressions to emit."""

import math

import numpy as np
from hypothesis import strategies as st
from pydrake import symbolic
from pydrake.symbolic import Expression, Variable

from drake_formation.lowering.emit import HEAD, emit
from drake_formation.lowering.expressions import Graph, Leaf


class Block:
    """Numbers that a block reads: state, parameters and a vector for each of its like input ports."""

    def __init__(self, rng, ports=5, size=2, parameters=10, states=4):
        self.leaves = {}
        self.parameters = [self._variable(Leaf("parameter", 0, k)) for k in range(parameters)]
        self.state = [self._variable(Leaf("state", 0, k)) for k in range(states)]
        self.inputs = [[self._variable(Leaf("input", port, k)) for k in range(size)] for port in range(ports)]
        self.numbers = {leaf: float(rng.uniform(0.5, 2.0)) for _, leaf in self.leaves.values()}

    def _variable(self, leaf):
        variable = Variable(f"{leaf.space}_{leaf.group}_{leaf.offset}")
        self.leaves[variable.get_id()] = (variable, leaf)
        return Expression(variable)

    def graph(self):
        return Graph({identifier: leaf for identifier, (_, leaf) in self.leaves.items()})

    def evaluate(self, expression):
        return expression.Evaluate({variable: self.numbers[leaf] for variable, leaf in self.leaves.values()})

    def run(self, graph, roots, extra=None):
        """What the kernel of some nodes writes, with further numbers by space."""
        kernel = emit(graph, roots, len(self.inputs))
        spaces = {("parameter", 0): self.parameters, ("state", 0): self.state}
        memory, starts = [], {}
        for (space, group), members in spaces.items():
            starts[space, group] = len(memory)
            memory += [self.numbers[Leaf(space, group, k)] for k in range(len(members))]
        for (space, group), values in (extra or {}).items():
            starts[space, group] = len(memory)
            memory += list(values)
        ports = []
        for port, members in enumerate(self.inputs):
            ports.append(len(memory))
            memory += [self.numbers[Leaf("input", port, k)] for k in range(len(members))]
        row = [0, *(starts[group] for group in kernel.groups), *kernel.turns, *ports]
        results = []
        for body in {kernel.body, kernel.body_with(kernel.turns)}:
            namespace = {"math": math, "np": np}
            exec(HEAD.format(name="kernel") + "\n" + body, namespace)
            out = [math.nan] * len(roots)
            namespace["kernel"](0.0, memory, [2, 1, 3, *row], 0, out)
            results.append(out)
        assert results[0] == results[-1]
        return results[0], kernel


seeds = st.integers(0, 2**32 - 1).map(np.random.default_rng)


def spring_like(block, port):
    """A term with everything: inputs and parameters that move, state that does not, roots and quotients."""
    dx, dy = (block.state[k] - block.inputs[port][k] for k in (0, 1))
    distance = (dx * dx + dy * dy + 1.0) ** 0.5
    return block.parameters[2 * port] * (1.0 - block.parameters[2 * port + 1] / distance) * dx


def random_expression(rng, leaves, depth):
    """Any expression of some leaves, defined for positive numbers."""
    if depth == 0:
        return leaves[rng.integers(len(leaves))]
    a, b = (random_expression(rng, leaves, depth - 1) for _ in range(2))
    return [
        lambda: a + b,
        lambda: a - b,
        lambda: a * b,
        lambda: a / (b * b + 1.0),
        lambda: (a * a + 1.0) ** 0.5,
        lambda: -a,
        lambda: symbolic.max(a - b, 0.0) * b,
        lambda: symbolic.min(a, b),
        lambda: symbolic.if_then_else(a > b, a, b),
        lambda: symbolic.sin(a) + a**3,
    ][rng.integers(10)]()
