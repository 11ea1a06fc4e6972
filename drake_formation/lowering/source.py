"""The source of a compiled module: its kernels, and the function that runs them."""

import re

from drake_formation.lowering.schedule import Program

HEAD = """import math

import numpy as np
from numba import njit
"""
KERNEL = """

@njit(forceinline=True, {options})
def {name}(t, m, table, step, out):
{body}
"""
DERIVATIVES = """

@njit("void(float64[::1], uint32[::1])", cache=True, {options})
def prepare(m, table):
    t = 0.0
{once}


@njit("void(float64, float64[::1], float64[::1], uint32[::1], float64[::1])", cache=True, {options})
def derivatives(t, x, m, table, dx):
    for k in range(x.size):
        m[k] = x[k]
{always}
"""
OUTPUTS = """

@njit(
    "void(float64[::1], float64[:, ::1], float64[::1], uint32[::1], uint32[::1], float64[:, ::1])",
    cache=True,
    {options},
)
def outputs(times, states, m, table, addresses, values):
    t = 0.0
{once}
    for sample in range(times.size):
        t = times[sample]
        for k in range(states.shape[1]):
            m[k] = states[sample, k]
{always}
        for k in range(addresses.size):
            values[sample, k] = m[addresses[k]]
"""
UPDATE = """

@njit("void(float64, float64[::1], uint32[::1], uint8[::1])", cache=True, {options})
def update(t, m, table, due):
{once}
{always}
    return
"""
COMPILED_LAW = re.compile(r"\b(drake_formation_compiled_\w+)\.step")
OPTIONS = 'error_model="numpy", fastmath={"contract", "arcp", "nsz", "reassoc"}'
"""Division by zero gives infinity, as in C++; it shows as a state that is no longer finite. Sums may be taken in
another order, so that loops over neighbours run on vector units; infinities and NaN keep their meaning.
"""


EXACT = 'error_model="numpy"'
"""Updates count, compare and draw, so they are computed as they are written."""


def update_source(program: Program) -> str:
    """Source of ``update(t, m, table, due)``, which carries out the updates of those ticks that are due."""
    return _module(program, UPDATE, "    ", EXACT)


def derivatives_source(program: Program) -> str:
    """Source of ``prepare(m, table)``, which computes what is fixed, and ``derivatives(t, x, m, table, dx)``."""
    return _module(program, DERIVATIVES, "    ")


def outputs_source(program: Program) -> str:
    """Source of ``outputs(times, states, m, table, addresses, values)``."""
    return _module(program, OUTPUTS, "        ")


def _module(program: Program, functions: str, indent: str, options: str = OPTIONS) -> str:
    bodies = [*program.once, *program.outputs, *program.last]
    names = {body: f"kernel_{k}" for k, body in enumerate(dict.fromkeys(bodies))}
    kernels = [KERNEL.format(name=name, body=body, options=options) for body, name in names.items()]
    targets = ["m"] * (len(program.once) + len(program.outputs)) + ["m" if program.ticks else "dx"] * len(program.last)
    calls = [
        f"{names[body]}(t, m, table, {2 * step}, {target})"
        for step, (body, target) in enumerate(zip(bodies, targets, strict=True))
    ]
    for k, tick in enumerate(program.ticks):
        step = len(program.once) + len(program.outputs) + k
        calls[step] = f"if due[{tick}]:\n{indent}    {calls[step]}"
    once, always = calls[: len(program.once)], calls[len(program.once) :]
    text = functions.format(
        once="\n".join(f"    {call}" for call in once),
        always="\n".join(f"{indent}{call}" for call in always),
        options=options,
    )
    laws = sorted({name for body in bodies for name in COMPILED_LAW.findall(body)})
    return "".join([HEAD, *(f"import {law}\n" for law in laws), *kernels, text])
