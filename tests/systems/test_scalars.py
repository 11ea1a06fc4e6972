import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.autodiffutils import AutoDiffXd
from pydrake.symbolic import Expression, Variable

from drake_formation.systems.scalars import at_most, atan2, largest, positive_part

numbers = st.floats(-1e6, 1e6)


@given(numbers)
def test_positive_part_is_the_same_for_every_scalar(x):
    expected = max(x, 0.0)
    variable = Variable("x")
    assert positive_part(x) == expected
    assert positive_part(AutoDiffXd(x, [1.0])).value() == expected
    assert positive_part(Expression(variable)).Evaluate({variable: x}) == expected
    assert positive_part(np.array([x, -x])).tolist() == [expected, max(-x, 0.0)]


def test_positive_part_is_flat_below_zero_and_has_slope_one_above():
    assert positive_part(AutoDiffXd(-2.0, [1.0])).derivatives() == [0.0]
    assert positive_part(AutoDiffXd(2.0, [1.0])).derivatives() == [1.0]


@given(numbers, numbers)
def test_at_most_is_the_same_for_every_scalar(x, bound):
    expected = float(x <= bound)
    a, b = Variable("a"), Variable("b")
    assert at_most(x, bound) == expected
    assert at_most(AutoDiffXd(x, [1.0]), AutoDiffXd(bound, [1.0])) == expected
    assert at_most(Expression(a), Expression(b)).Evaluate({a: x, b: bound}) == expected


@given(numbers)
def test_at_most_includes_the_bound(x):
    assert at_most(x, x) == 1.0


@given(st.lists(numbers, min_size=1, max_size=9))
def test_largest_is_the_same_for_every_scalar(values):
    variables = [Variable(f"x{k}") for k in range(len(values))]
    found = largest([Expression(variable) for variable in variables])
    assert largest(values) == max(values)
    assert largest([AutoDiffXd(x, [1.0]) for x in values]).value() == max(values)
    assert found.Evaluate(dict(zip(variables, values, strict=True))) == max(values)


@given(numbers, numbers)
def test_atan2_is_the_same_for_every_scalar(y, x):
    a, b = Variable("a"), Variable("b")
    expected = pytest.approx(math.atan2(y, x), rel=1e-15)
    assert atan2(y, x) == expected
    assert atan2(AutoDiffXd(y, [1.0]), AutoDiffXd(x, [0.0])).value() == expected
    assert atan2(Expression(a), Expression(b)).Evaluate({a: y, b: x}) == expected
