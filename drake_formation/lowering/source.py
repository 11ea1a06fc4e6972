"""The source of a compiled module: its kernels, and the function that runs them."""

from drake_formation.lowering.schedule import Program

HEAD = """import math

import numpy as np
from numba import njit
"""
KERNEL = """

@njit({options})
def {name}(t, m, table, step, out):
{body}
"""
DERIVATIVES = """

@njit("void(float64, float64[::1], float64[::1], uint32[::1], float64[::1])", cache=True, {options})
def derivatives(t, x, m, table, dx):
    for k in range(x.size):
        m[k] = x[k]
{calls}
"""
OUTPUTS = """

@njit(
    "void(float64[::1], float64[:, ::1], float64[::1], uint32[::1], uint32[::1], float64[:, ::1])",
    cache=True,
    {options},
)
def outputs(times, states, m, table, addresses, values):
    for sample in range(times.size):
        t = times[sample]
        for k in range(states.shape[1]):
            m[k] = states[sample, k]
{calls}
        for k in range(addresses.size):
            values[sample, k] = m[addresses[k]]
"""
OPTIONS = 'error_model="numpy", fastmath={"contract", "arcp", "nsz", "reassoc"}'
"""Division by zero gives infinity, as in C++; it shows as a state that is no longer finite. Sums may be taken in
another order, so that loops over neighbours run on vector units; infinities and NaN keep their meaning.
"""


def derivatives_source(program: Program) -> str:
    """Source of ``derivatives(t, x, m, table, dx)``."""
    targets = ["m"] * len(program.outputs) + ["dx"] * len(program.derivatives)
    return _module([*program.outputs, *program.derivatives], targets, DERIVATIVES, "    ")


def outputs_source(program: Program) -> str:
    """Source of ``outputs(times, states, m, table, addresses, values)``."""
    return _module(program.outputs, ["m"] * len(program.outputs), OUTPUTS, "        ")


def _module(bodies: list[str], targets: list[str], function: str, indent: str) -> str:
    names = {body: f"kernel_{k}" for k, body in enumerate(dict.fromkeys(bodies))}
    kernels = [KERNEL.format(name=name, body=body, options=OPTIONS) for body, name in names.items()]
    calls = [
        f"{indent}{names[body]}(t, m, table, {2 * step}, {target})"
        for step, (body, target) in enumerate(zip(bodies, targets, strict=True))
    ]
    return "".join([HEAD, *kernels, function.format(calls="\n".join(calls), options=OPTIONS)])
