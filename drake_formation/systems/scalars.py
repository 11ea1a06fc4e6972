"""Arithmetic that floats, arrays, AutoDiffXd and Expression do not share."""

from typing import Any

import numpy as np
from pydrake import symbolic
from pydrake.symbolic import Expression

Scalar = Any
"""float, AutoDiffXd or Expression; the laws of the blocks accept arrays of floats too."""


def positive_part(x: Scalar) -> Scalar:
    """max(0, x), of any scalar or an array of floats."""
    if isinstance(x, float):
        return x if x > 0.0 else 0.0
    if isinstance(x, Expression):
        return symbolic.max(x, 0.0)
    if isinstance(x, np.ndarray):
        return np.maximum(x, 0.0)
    return x if x > 0.0 else 0.0 * x


def at_most(x: Scalar, bound: Scalar) -> Scalar:
    """1 where x ≤ bound and 0 elsewhere, of any scalar."""
    if isinstance(x, Expression) or isinstance(bound, Expression):
        return symbolic.if_then_else(x <= bound, Expression(1.0), Expression(0.0))
    return 1.0 if x <= bound else 0.0
