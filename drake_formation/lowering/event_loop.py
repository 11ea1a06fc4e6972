"""From update to update without leaving compiled code.

This file is compiled through :mod:`drake_formation.machine_code`, once for all diagrams: all that belongs to a diagram
is an argument.
"""

import numpy as np
from numba import njit, types

DONE = 0

_vector, _matrix, _table = types.float64[::1], types.float64[:, ::1], types.uint32[::1]
_whole, _flags = types.int64[::1], types.uint8[::1]
_derivatives = types.FunctionType(types.void(types.float64, _vector, _vector, _table, _vector))
_prepare = types.FunctionType(types.void(_vector, _table))
_update = types.FunctionType(types.void(types.float64, _vector, _table, _flags))
_outputs = types.FunctionType(types.void(_vector, _matrix, _vector, _table, _table, _matrix))
_counts = types.UniTuple(types.int64, 4)  # type: ignore[no-untyped-call]
_integrate = types.FunctionType(
    _counts(
        _derivatives, _vector, types.float64, _vector, _vector, _table, types.float64, types.float64, types.boolean,
        _vector, _vector, _matrix,
    )
)  # fmt: skip
_signature = _counts(
    _integrate, _derivatives, _prepare, _update, _outputs, _vector, types.float64, _vector, _vector, _table, _table,
    _table, _table, _vector, _vector, _whole, types.boolean, types.float64, types.float64, types.boolean, _vector,
    _vector, _matrix, _matrix,
)  # fmt: skip


@njit("void(float64[::1], float64[:, ::1], float64[::1], uint32[::1], uint32[::1], float64[:, ::1])", cache=True)
def nothing(times, states, m, table, addresses, values):  # type: ignore[no-untyped-def]
    """No outputs."""


@njit(_signature, error_model="numpy", cache=True)
def run(  # type: ignore[no-untyped-def]
    integrate, derivatives, prepare, update, outputs, clock, end, x, m, table, update_table, output_table, addresses,
    offsets, periods, counts, updated, accuracy, max_step, adaptive, at, times, states, values,
):  # fmt: skip
    """Integrate and update until the end, until the samples are full or until it cannot go on.

    Args:
        integrate: from one update to the next; see :mod:`drake_formation.lowering.dormand_prince`.
        derivatives: of the diagram.
        prepare: computes what is fixed between two updates.
        update: carries out what is due.
        outputs: computes what is recorded.
        clock: time, next step and last error; updated.
        end: where to stop, exactly; updates due then are not carried out.
        x: state; updated.
        m: memory of all these functions; the discrete state in it is updated.
        table: table of the derivatives.
        update_table: table of the updates.
        output_table: table of the outputs.
        addresses: where what is recorded stands in the memory.
        offsets: of every row of ticks, the first (s).
        periods: what lies between two (s).
        counts: number of the next tick of each, not before the time; updated.
        updated: whether the updates due at the start have been carried out.
        accuracy: largest error of a step.
        max_step: largest step.
        adaptive: control the step.
        at: times to sample at, rising, of which none is before the time; where empty, every step is a sample.
        times: sample times; written.
        states: sampled states; written.
        values: what is recorded at the samples; written.

    Returns:
        Status, samples written, derivatives evaluated, steps rejected.
    """
    due = np.zeros(offsets.size, dtype=np.uint8)
    every = at.size == 0
    none = np.full(1, np.inf)
    samples, evaluations, rejected, upcoming = 0, 0, 0, 0
    while clock[0] < end:
        some = False
        for k in range(offsets.size):
            due[k] = offsets[k] + counts[k] * periods[k] == clock[0]
            if due[k]:
                counts[k] += 1
                some = True
        if some and not updated:
            for i in range(x.size):
                m[i] = x[i]
            update(clock[0], m, update_table, due)
            prepare(m, table)
        updated = False
        stop = end
        for k in range(offsets.size):
            stop = min(stop, offsets[k] + counts[k] * periods[k])
        last = upcoming
        while last < at.size and (at[last] < stop or (stop == end and at[last] <= end)):
            last += 1
        wanted = at if every else (at[upcoming:last] if last > upcoming else none)
        upcoming = last
        status, count, more, worse = integrate(
            derivatives, clock, stop, x, m, table, accuracy, max_step, adaptive, wanted, times[samples:],
            states[samples:],
        )  # fmt: skip
        if addresses.size > 0 and count > 0:
            outputs(
                times[samples : samples + count], states[samples : samples + count], m, output_table, addresses,
                values[samples : samples + count],
            )  # fmt: skip
        samples += count
        evaluations += more
        rejected += worse
        if status != DONE:
            return status, samples, evaluations, rejected
    return DONE, samples, evaluations, rejected
