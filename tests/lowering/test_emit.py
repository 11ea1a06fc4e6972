"""Emitted code computes what the expressions say."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from kernels import Block, random_expression, seeds, spring_like
from pydrake import symbolic


@given(seeds, st.integers(1, 8))
def test_sums_over_ports(rng, ports):
    block = Block(rng, ports, parameters=2 * ports)
    expression = sum(spring_like(block, port) for port in range(ports))
    graph = block.graph()
    (found,), kernel = block.run(graph, [graph.read(expression)])
    np.testing.assert_allclose(found, block.evaluate(expression), rtol=1e-12)
    assert kernel.turns == ((ports,) if ports >= 3 else ())


@given(seeds, st.integers(3, 12), st.integers(3, 12))
def test_the_code_does_not_grow_with_the_ports(rng, few, many):
    bodies = set()
    for ports in (few, many):
        block = Block(rng, ports, parameters=2 * ports)
        graph = block.graph()
        _, kernel = block.run(graph, [graph.read(sum(spring_like(block, port) for port in range(ports)))])
        bodies.add(kernel.body)
    assert len(bodies) == 1


@given(seeds, st.integers(3, 8))
def test_like_values_are_kept_in_a_loop(rng, ports):
    block = Block(rng, ports, parameters=2 * ports)
    expressions = [spring_like(block, port) for port in range(ports)]
    expressions.insert(0, block.state[2] * 2.0)
    graph = block.graph()
    found, kernel = block.run(graph, [graph.read(expression) for expression in expressions])
    np.testing.assert_allclose(found, [block.evaluate(expression) for expression in expressions], rtol=1e-12)
    assert kernel.body.count("math.sqrt") == 1


@given(seeds, st.integers(1, 4))
def test_any_expressions(rng, depth):
    block = Block(rng)
    leaves = [*block.parameters[:3], *block.state, *block.inputs[0], *block.inputs[1]]
    expressions = [random_expression(rng, leaves, depth) for _ in range(4)]
    graph = block.graph()
    found, _ = block.run(graph, [graph.read(expression) for expression in expressions])
    np.testing.assert_allclose(found, [block.evaluate(e) for e in expressions], rtol=1e-10, atol=1e-12)


def test_what_is_not_positive_is_skipped():
    """Where the positive part is zero, the rest of the product is not computed: here it would divide by zero."""
    block = Block(np.random.default_rng(0))
    a, b = block.state[:2]
    block.numbers |= {leaf: 1.0 for leaf in block.numbers if leaf.space == "state"}
    graph = block.graph()
    (found,), _ = block.run(graph, [graph.read(symbolic.max(a - 2.0, 0.0) / (a - b))])
    assert found == 0.0


def test_what_is_not_a_number_is_not_skipped():
    block = Block(np.random.default_rng(0))
    block.numbers |= {leaf: np.nan for leaf in block.numbers if leaf.space == "state"}
    graph = block.graph()
    (found,), _ = block.run(graph, [graph.read(symbolic.max(block.state[0], 0.0) * block.state[1])])
    assert np.isnan(found)
