"""What is fixed is computed once, and all is as before."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from kernels import Block, random_expression, seeds, spring_like

from drake_formation.lowering.expressions import Leaf
from drake_formation.lowering.hoisting import HOISTED, hoist, is_fixed


def same_in_two_parts(block, expressions, fixed_ports):
    """Values computed in two parts, what is computed once, and the leaves of what is computed in every step."""
    graph = block.graph()
    once, always = hoist(graph, [graph.read(expression) for expression in expressions], fixed_ports, group=0)
    kept = block.run(graph, once)[0] if once else []
    found, _ = block.run(graph, always, {(HOISTED, 0): kept})
    np.testing.assert_allclose(found, [block.evaluate(e) for e in expressions], rtol=1e-10, atol=1e-12)
    for number in once:
        leaves = [graph.nodes[leaf].content for leaf in graph.leaves(number)]
        assert all(is_fixed(leaf, fixed_ports) for leaf in leaves)
    return graph, once, always


@given(seeds, st.integers(1, 4), st.sets(st.integers(0, 1)))
def test_any_expressions(rng, depth, fixed_ports):
    block = Block(rng)
    leaves = [*block.parameters[:3], *block.state, *block.inputs[0], *block.inputs[1]]
    same_in_two_parts(block, [random_expression(rng, leaves, depth) for _ in range(4)], fixed_ports)


@given(seeds, st.integers(3, 8))
def test_rest_lengths_of_all_springs_are_kept_in_a_loop(rng, ports):
    block = Block(rng, ports, parameters=2 * ports)

    def term(port):
        hx, hy = block.parameters[2 * port : 2 * port + 2]
        return (hx * hx + hy * hy) ** 0.5 * (block.state[0] - block.inputs[port][0])

    graph, once, always = same_in_two_parts(block, [sum(term(port) for port in range(ports))], set())
    assert len(once) == ports
    _, kernel = block.run(graph, once)
    assert kernel.body.count("math.sqrt") == 1
    _, kernel = block.run(graph, always, {(HOISTED, 0): np.ones(ports)})
    assert "math.sqrt" not in kernel.body


@given(seeds)
def test_a_spring_keeps_its_loop(rng):
    block = Block(rng)
    same_in_two_parts(block, [sum(spring_like(block, port) for port in range(5))], {0, 1, 2, 3, 4})


def test_a_division_by_what_is_fixed_is_a_product():
    block = Block(np.random.default_rng(0))
    graph, once, always = same_in_two_parts(block, [block.state[0] / block.parameters[0]], set())
    assert graph.nodes[always[0]].operation == "Mul"
    assert [graph.nodes[number].operation for number in once] == ["Div"]


def test_time_and_state_are_not_fixed():
    assert is_fixed(Leaf("parameter", 0, 0), ())
    assert is_fixed(Leaf("input", 3, 0), {3})
    assert not is_fixed(Leaf("input", 3, 0), {2})
    assert not is_fixed(Leaf("state", 0, 0), ())
    assert not is_fixed(Leaf("time", 0, 0), ())
