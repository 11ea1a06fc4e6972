"""An exponential Runge-Kutta method of order 4 with step control, compiled (Krogstad 2005, after Cox & Matthews 2002).

ẋ = J x + g(t, x), with a constant matrix J, the Jacobian somewhere: J is integrated exactly, so that springs, real and
virtual, do not bound the step as long as they stay near where they were linearized; what is left, g, is stepped over.

The error of two steps is taken from one of twice the length, for what makes it, a force that comes and goes within a
step, escapes the estimates that an embedded method gives for little more. All lengths are halves of halves of one,
for which the matrix functions are made beforehand.

This file is compiled through :mod:`drake_formation.machine_code`, once for all diagrams.
"""

import math
from typing import Any

import numpy as np
from numba import njit, types

DONE, FULL, NOT_FINITE, STEP_TOO_SMALL = 0, 1, 2, 3

ORDER = 4
GROW = 1 / 64
"""Share of the accuracy below which steps are doubled; their error becomes some 32 times as large."""

SMOOTH = 1e2
"""Where every step is sampled, the middle of two may be so many times the accuracy off the cubic through their ends.

What is read between samples goes by position, velocity and acceleration at both ends of one step, which is far nearer;
so ringing that matters shortens the steps until it shows.
"""
SMOOTHER = 1 / 32
"""Share of that below which steps are doubled; it becomes some 16 times as large."""

_vector, _matrix, _table = types.float64[::1], types.float64[:, ::1], types.uint32[::1]
_functions = types.float64[:, :, :, ::1]
_derivatives = types.FunctionType(types.void(types.float64, _vector, _vector, _table, _vector))
_signature = types.UniTuple(types.int64, 4)(  # type: ignore[no-untyped-call]
    _derivatives, _vector, _vector, _vector, _vector, _table, _matrix, _functions, types.float64, types.float64,
    types.boolean, types.boolean, _vector, _matrix,
)  # fmt: skip

OPTIONS: Any = {"error_model": "numpy", "fastmath": {"contract", "reassoc"}}


@njit(**OPTIONS)
def product(matrix, vector, out):  # type: ignore[no-untyped-def]
    """Out = matrix @ vector; for a few states this is quicker than a library's."""
    for i in range(vector.size):
        total = 0.0
        for k in range(vector.size):
            total += matrix[i, k] * vector[k]
        out[i] = total


@njit(**OPTIONS)
def rest(derivatives, t, x, m, table, j, out):  # type: ignore[no-untyped-def]
    """g(t, x) = ẋ − J x."""
    derivatives(t, x, m, table, out)
    for i in range(x.size):
        total = 0.0
        for k in range(x.size):
            total += j[i, k] * x[k]
        out[i] -= total


@njit(**OPTIONS)
def step(derivatives, t, h, u, g1, m, table, j, whole, half, work, y):  # type: ignore[no-untyped-def]
    """One step from u, where g is g1, to y; three times g."""
    a, b, g2, g3, g4, d, p = work[0], work[1], work[2], work[3], work[4], work[5], work[6]
    n = u.size
    product(half[0], u, a)
    product(half[1], g1, p)
    for i in range(n):
        a[i] += 0.5 * h * p[i]
    rest(derivatives, t + 0.5 * h, a, m, table, j, g2)
    for i in range(n):
        d[i] = g2[i] - g1[i]
    product(half[2], d, p)
    for i in range(n):
        b[i] = a[i] + h * p[i]
    rest(derivatives, t + 0.5 * h, b, m, table, j, g3)
    product(whole[0], u, y)
    product(whole[1], g1, p)
    for i in range(n):
        y[i] += h * p[i]
        d[i] = g3[i] - g1[i]
    product(whole[2], d, p)
    for i in range(n):
        b[i] = y[i] + 2.0 * h * p[i]
    rest(derivatives, t + h, b, m, table, j, g4)
    for i in range(n):
        d[i] = 2.0 * (g2[i] + g3[i]) - 3.0 * g1[i] - g4[i]
    product(whole[2], d, p)
    for i in range(n):
        y[i] += h * p[i]
        d[i] = 4.0 * (g1[i] - g2[i] - g3[i] + g4[i])
    product(whole[3], d, p)
    for i in range(n):
        y[i] += h * p[i]


@njit(**OPTIONS)
def distance(x, y):  # type: ignore[no-untyped-def]
    """Largest difference of two states; not finite where they are not."""
    result = 0.0
    for i in range(x.size):
        e = abs(x[i] - y[i])
        if not e <= result:  # NaN counts
            result = e
            if not math.isfinite(e):
                break
    return result


@njit(**OPTIONS)
def off_the_cubic(u, middle, y, g1, g3, j, h, p, q):  # type: ignore[no-untyped-def]
    """How far the middle of two steps of length h is off the cubic through their ends, in any state."""
    product(j, u, p)
    product(j, y, q)
    for i in range(u.size):
        slopes = p[i] + g1[i] - q[i] - g3[i]
        p[i] = 0.5 * (u[i] + y[i]) + 0.25 * h * slopes
    return distance(middle, p)


@njit(_signature, cache=True, **OPTIONS)
def integrate(derivatives, clock, stops, x, m, table, j, phi, longest, accuracy, adaptive, every, times, states):  # type: ignore[no-untyped-def]  # noqa: PLR0915
    """Integrate to some times, which lie apart by a multiple of one length.

    Args:
        derivatives: ``derivatives(t, x, m, table, dx)``.
        clock: time and level of the step; updated.
        stops: times to come by, rising.
        x: state; updated. Where the state is not finite any more, that state.
        m: memory of the derivatives.
        table: table of the derivatives.
        j: the matrix J.
        phi: φ_0 … φ_3 of J times the length and its halves, shape (levels + 1, 4, n, n).
        longest: the length, of two steps.
        accuracy: largest error of two steps.
        adaptive: control the step; else all are the longest.
        every: sample every step; else at the stops alone.
        times: sample times; written.
        states: sampled states; written.

    Returns:
        Status, samples written, derivatives evaluated, steps rejected.
    """
    n, levels = x.size, phi.shape[0] - 2
    u, middle, y, coarse = x.copy(), np.empty(n), np.empty(n), np.empty(n)
    g1, g2, g3 = np.empty(n), np.empty(n), np.empty(n)
    work = np.empty((7, n))
    t, level = clock[0], (int(clock[1]) if adaptive else 0)
    samples, evaluations, rejected = 0, 1, 0
    rest(derivatives, t, u, m, table, j, g1)
    for stop in stops:
        begin = t
        total = round((stop - begin) / longest) * 2**levels
        position = 0  # in the shortest steps
        while position < total:
            if every and samples + 2 > times.size:
                x[:] = u
                clock[0], clock[1] = t, level
                return FULL, samples, evaluations, rejected
            stride = 2 ** (levels - level)
            h = 0.5 * longest / 2.0**level
            whole, half, quarter = phi[level], phi[level + 1], phi[level + 2]
            reached = stop if position + stride == total else begin + (position + stride) * (longest / 2.0**levels)
            step(derivatives, t, h, u, g1, m, table, j, half, quarter, work, middle)
            rest(derivatives, t + h, middle, m, table, j, g2)
            step(derivatives, t + h, h, middle, g2, m, table, j, half, quarter, work, y)
            rest(derivatives, reached, y, m, table, j, g3)
            evaluations += 8
            error = distance(y, y - y)
            bend = 0.0
            if adaptive:
                step(derivatives, t, 2.0 * h, u, g1, m, table, j, whole, half, work, coarse)
                evaluations += 3
                error = distance(y, coarse) / ((2.0**ORDER - 1.0) * accuracy)
                if every:
                    bend = off_the_cubic(u, middle, y, g1, g3, j, h, work[0], work[1]) / (SMOOTH * accuracy)
                if not (error <= 1.0 and bend <= 1.0) and level < levels - 1:
                    rejected += 2
                    level += 1
                    continue
            if not math.isfinite(error):
                x[:] = y
                clock[0] = t
                return NOT_FINITE, samples, evaluations, rejected
            if adaptive and not error <= 1.0:
                x[:] = u
                clock[0] = t
                return STEP_TOO_SMALL, samples, evaluations, rejected
            if every:
                times[samples], times[samples + 1] = t + h, reached
                states[samples], states[samples + 1] = middle, y
                samples += 2
            t = reached
            position += stride
            u, y = y, u
            g1, g3 = g3, g1
            if adaptive and error < GROW and bend < SMOOTHER and level > 0 and position % (2 * stride) == 0:
                level -= 1
        if not every:
            times[samples], states[samples] = t, u
            samples += 1
    x[:] = u
    clock[0], clock[1] = t, level
    return DONE, samples, evaluations, rejected
