"""Drake's expressions as nodes."""

import numpy as np
import pytest
from kernels import Block
from pydrake import symbolic

from drake_formation.lowering.expressions import Leaf, UnsupportedOperationError


@pytest.fixture
def block():
    return Block(np.random.default_rng(0))


def operation(graph, number):
    return graph.nodes[number].operation


def test_equal_subexpressions_are_one_node(block):
    graph, (x, y) = block.graph(), block.state[:2]
    assert graph.read((x + y) * (x + y)) == graph.read((x + y) ** 2)
    before = len(graph.nodes)
    graph.read(x + y)
    assert len(graph.nodes) == before


def test_leaves_come_in_reading_order_each_once(block):
    graph, (x, y) = block.graph(), block.state[:2]
    found = [graph.nodes[number].content for number in graph.leaves(graph.read(x * (y + x * y)))]
    assert sorted(found) == [Leaf("state", 0, 0), Leaf("state", 0, 1)]


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (lambda x: x**0.5, "Sqrt"),
        (lambda x: x**3, "Mul"),
        (lambda x: x**-1.0, "Div"),
        (lambda x: x**2.5, "Pow"),
        (lambda x: -x, "Neg"),
        (lambda x: x + 0.0, "leaf"),
        (lambda x: 1.0 * x, "leaf"),
        (lambda x: symbolic.max(x, 0.0), "Max"),
    ],
)
def test_what_is_cheaper_another_way_is_written_so(block, expression, expected):
    graph = block.graph()
    assert operation(graph, graph.read(expression(block.state[0]))) == expected


def test_what_has_no_counterpart_is_named(block):
    with pytest.raises(UnsupportedOperationError, match="UninterpretedFunction"):
        block.graph().read(symbolic.uninterpreted_function("magic", [block.state[0]]))
