"""Arithmetic that floats, arrays, AutoDiffXd and Expression do not share."""

import math
from bisect import bisect_right
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from pydrake import symbolic
from pydrake.math import arctan2
from pydrake.symbolic import Expression

Scalar = Any
"""float, AutoDiffXd or Expression; the laws of the blocks accept arrays of floats too."""


def sin(x: Scalar) -> Scalar:
    """Sine of an angle (rad), of any scalar or an array of floats."""
    return math.sin(x) if isinstance(x, float) else np.sin(x) if isinstance(x, np.ndarray) else x.sin()


def cos(x: Scalar) -> Scalar:
    """Cosine of an angle (rad), of any scalar or an array of floats."""
    return math.cos(x) if isinstance(x, float) else np.cos(x) if isinstance(x, np.ndarray) else x.cos()


def floor(x: Scalar) -> Scalar:
    """The largest whole number that is not larger, of any scalar or an array of floats."""
    if isinstance(x, float):
        return float(math.floor(x))
    return np.floor(x) if isinstance(x, np.ndarray) else symbolic.floor(x)


def log(x: Scalar) -> Scalar:
    """Natural logarithm, of any scalar or an array of floats."""
    return math.log(x) if isinstance(x, float) else np.log(x) if isinstance(x, np.ndarray) else symbolic.log(x)


def atan2(y: Scalar, x: Scalar) -> Scalar:
    """Angle of the vector (x, y) from the x axis (rad), of any scalar."""
    return arctan2(y, x)


def at_least(x: Scalar, bound: Scalar) -> Scalar:
    """max(x, bound), of any scalar or an array of floats."""
    if isinstance(x, float):
        return x if x > bound else bound
    if isinstance(x, Expression):
        return symbolic.max(x, bound)
    if isinstance(x, np.ndarray):
        return np.maximum(x, bound)
    return x if x > bound else 0.0 * x + bound


def largest(values: Sequence[Scalar]) -> Scalar:
    """The largest of some scalars, at least one; taken in pairs, so that an expression of many is not deep."""
    left = list(values)
    while len(left) > 1:
        odd = left[2 * (len(left) // 2) :]
        left = [at_least(a, b) for a, b in zip(left[::2], left[1::2], strict=False)] + odd
    return left[0]


def positive_part(x: Scalar) -> Scalar:
    """max(0, x), of any scalar or an array of floats."""
    return at_least(x, 0.0)


def lesser(x: Scalar, y: Scalar) -> Scalar:
    """min(x, y), of any scalars alike or arrays of floats."""
    if isinstance(x, Expression):
        return symbolic.min(x, y)
    if isinstance(x, np.ndarray):
        return np.minimum(x, y)
    return x if x < y else y


def at_most(x: Scalar, bound: Scalar) -> Scalar:
    """1 where x ≤ bound and 0 elsewhere, of any scalar or an array of floats."""
    if isinstance(x, np.ndarray):
        return np.where(x <= bound, 1.0, 0.0)
    if isinstance(x, Expression) or isinstance(bound, Expression):
        return symbolic.if_then_else(x <= bound, Expression(1.0), Expression(0.0))
    return 1.0 if x <= bound else 0.0


def chosen(x: Scalar, bound: Scalar, within: Scalar, beyond: Scalar) -> Scalar:
    """One value where x ≤ bound and another elsewhere, of any scalars alike or arrays of floats."""
    if isinstance(x, np.ndarray):
        return np.where(x <= bound, within, beyond)
    if isinstance(x, Expression) or isinstance(bound, Expression):
        return symbolic.if_then_else(x <= bound, within, beyond)
    return within if x <= bound else beyond


def row_at(x: Scalar, bounds: list[Scalar], rows: list[list[Scalar]]) -> list[Scalar]:
    """The row of the last bound that x has reached, or the first row before all bounds, of any scalar.

    Args:
        x: where.
        bounds: ascending.
        rows: one for each bound, of equal lengths.
    """
    if not isinstance(x, Expression):
        return rows[max(bisect_right(bounds, x) - 1, 0)]
    # One decision a bound, not one a number; 1 times the row and 0 times all others is the row to the last digit.
    reached = [1.0, *(at_most(bound, x) for bound in bounds[1:]), 0.0]
    chosen = [here - beyond for here, beyond in pairwise(reached)]
    return [
        sum(weight * value for weight, value in zip(chosen, column, strict=True)) for column in zip(*rows, strict=True)
    ]
