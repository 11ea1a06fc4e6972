"""The Dormand-Prince 5(4) pair with step control and dense output, compiled (Hairer, Nørsett & Wanner, Sec. II.4-6).

This file is compiled through :mod:`drake_formation.machine_code`, once for all diagrams: the right-hand side is an
argument. The error norm is Drake's: the largest absolute error of any state in one step, which the step control keeps
below the accuracy. The last stage of an accepted step is the first of the next.
"""

import math

import numpy as np
from numba import njit, types

DONE, FULL, NOT_FINITE, STEP_TOO_SMALL = 0, 1, 2, 3

SAFETY, SHRINK, GROW = 0.9, 0.2, 5.0
EXPONENT, MEMORY = 0.2 - 0.04 * 0.75, 0.04
"""Step control remembers the last error a little, which calms it where stability bounds the step."""
SMALLEST = 1e-14
"""A step shorter than this share of the time is lost in rounding."""

C2, C3, C4, C5 = 1 / 5, 3 / 10, 4 / 5, 8 / 9
A21 = 1 / 5
A31, A32 = 3 / 40, 9 / 40
A41, A42, A43 = 44 / 45, -56 / 15, 32 / 9
A51, A52, A53, A54 = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
A61, A62, A63, A64, A65 = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
B1, B3, B4, B5, B6 = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
E1, E3, E4, E5, E6, E7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40
D1, D3, D4 = -12715105075 / 11282082432, 87487479700 / 32700410799, -10690763975 / 1880347072
D5, D6, D7 = 701980252875 / 199316789632, -1453857185 / 822651844, 69997945 / 29380423

_vector, _matrix, _table = types.float64[::1], types.float64[:, ::1], types.uint32[::1]
_derivatives = types.FunctionType(types.void(types.float64, _vector, _vector, _table, _vector))
_signature = types.UniTuple(types.int64, 4)(  # type: ignore[no-untyped-call]
    _derivatives, _vector, types.float64, _vector, _vector, _table, types.float64, types.float64, types.boolean,
    _vector, _vector, _matrix,
)  # fmt: skip


@njit(_signature, error_model="numpy", cache=True)
def integrate(derivatives, clock, end, x, m, table, accuracy, max_step, adaptive, at, times, states):  # type: ignore[no-untyped-def]  # noqa: PLR0912, PLR0915
    """Integrate until the end, until the samples are full or until it cannot go on.

    Args:
        derivatives: ``derivatives(t, x, m, table, dx)``.
        clock: time, next step and last error; updated.
        end: where to stop, exactly.
        x: state; updated. Where the state is not finite any more, that state.
        m: memory of the derivatives.
        table: table of the derivatives.
        accuracy: largest error of a step.
        max_step: largest step.
        adaptive: control the step; else every step is the largest.
        at: times to sample at, by dense output; where empty, every accepted step is a sample.
        times: sample times; written.
        states: sampled states; written.

    Returns:
        Status, samples written, derivatives evaluated, steps rejected.
    """
    n = x.size
    k1, k2, k3, k4, k5, k6, k7 = (
        np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n), np.empty(n),
    )  # fmt: skip
    u, y = x.copy(), np.empty(n)
    t, h, last = clock[0], min(clock[1], max_step), clock[2]
    samples, evaluations, rejected, upcoming = 0, 1, 0, 0
    derivatives(t, u, m, table, k1)
    while t < end:
        if samples + 1 > times.size and at.size == 0:
            x[:] = u
            clock[0], clock[1], clock[2] = t, h, last
            return FULL, samples, evaluations, rejected
        if not adaptive:
            h = max_step
        smallest = SMALLEST * max(1.0, abs(t))
        ends = t + h >= end - smallest
        s = end - t if ends else h
        for i in range(n):
            y[i] = u[i] + s * A21 * k1[i]
        derivatives(t + C2 * s, y, m, table, k2)
        for i in range(n):
            y[i] = u[i] + s * (A31 * k1[i] + A32 * k2[i])
        derivatives(t + C3 * s, y, m, table, k3)
        for i in range(n):
            y[i] = u[i] + s * (A41 * k1[i] + A42 * k2[i] + A43 * k3[i])
        derivatives(t + C4 * s, y, m, table, k4)
        for i in range(n):
            y[i] = u[i] + s * (A51 * k1[i] + A52 * k2[i] + A53 * k3[i] + A54 * k4[i])
        derivatives(t + C5 * s, y, m, table, k5)
        for i in range(n):
            y[i] = u[i] + s * (A61 * k1[i] + A62 * k2[i] + A63 * k3[i] + A64 * k4[i] + A65 * k5[i])
        derivatives(t + s, y, m, table, k6)
        for i in range(n):
            y[i] = u[i] + s * (B1 * k1[i] + B3 * k3[i] + B4 * k4[i] + B5 * k5[i] + B6 * k6[i])
        derivatives(t + s, y, m, table, k7)
        evaluations += 6
        error = 0.0
        for i in range(n):
            e = abs(s * (E1 * k1[i] + E3 * k3[i] + E4 * k4[i] + E5 * k5[i] + E6 * k6[i] + E7 * k7[i]))
            if not e <= error:  # NaN counts
                error = e
                if not math.isfinite(e):
                    break
        if not math.isfinite(error) and (not adaptive or s <= smallest):
            x[:] = y
            clock[0] = t
            return NOT_FINITE, samples, evaluations, rejected
        error /= accuracy
        if adaptive:
            if not error <= 1.0:
                rejected += 1
                h = s * (max(SHRINK, SAFETY * error**-0.2) if math.isfinite(error) else SHRINK)
                if h < smallest:
                    if math.isfinite(error):
                        x[:] = u
                        clock[0] = t
                        return STEP_TOO_SMALL, samples, evaluations, rejected
                    h = smallest
                continue
            error = max(error, 1e-10)
            wanted = s * min(GROW, max(SHRINK, SAFETY * error**-EXPONENT * last**MEMORY))
            # A step cut short by the end says nothing about the step that would have been possible.
            h = min(max_step, max(wanted, h) if ends else wanted)
            last = max(error, 1e-4)
        reached = end if ends else t + s
        while upcoming < at.size and at[upcoming] <= reached:
            if at[upcoming] >= t:
                p = (at[upcoming] - t) / s
                q = 1.0 - p
                for i in range(n):
                    difference = y[i] - u[i]
                    bend = s * k1[i] - difference
                    twist = difference - s * k7[i] - bend
                    fourth = s * (D1 * k1[i] + D3 * k3[i] + D4 * k4[i] + D5 * k5[i] + D6 * k6[i] + D7 * k7[i])
                    states[samples, i] = u[i] + p * (difference + q * (bend + p * (twist + q * fourth)))
                times[samples] = at[upcoming]
                samples += 1
            upcoming += 1
        t = reached
        u, y = y, u
        k1, k7 = k7, k1
        if at.size == 0:
            times[samples] = t
            for i in range(n):
                states[samples, i] = u[i]
            samples += 1
    x[:] = u
    clock[0], clock[1], clock[2] = t, h, last
    return DONE, samples, evaluations, rejected
