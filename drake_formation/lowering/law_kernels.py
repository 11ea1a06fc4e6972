"""Kernels that are not traced: those that call the law of a sampled block, and those that put its results in place."""

from drake_formation.lowering.emit import Kernel
from drake_formation.systems.sampled_law import SampledLaw

LAW = """    for block in range(table[step + 1]):
        row = table[table[step] + block]
        aside, place, size = table[row], table[row + 1], table[row + 2]
        for k in range(size):
            m[aside + k] = m[place + k]
        inputs = table[row + 5]
        at = inputs
        for port in range({ports}):
            source, width = table[row + 6 + 2 * port], table[row + 7 + 2 * port]
            for k in range(width):
                m[at + k] = m[source + k]
            at += width
        numbers = table[row + 3]
        {module}.step(t, m[inputs:at], m[aside : aside + size], m[numbers : numbers + table[row + 4]])"""

PLACING = Kernel(
    """    for block in range(table[step + 1]):
        row = table[table[step] + block]
        for k in range(table[row + 2]):
            m[table[row + 1] + k] = m[table[row] + k]""",
    groups=(),
    turns=(),
    inputs=0,
)
"""A row is where the new state is, where it belongs, and its size."""


def law_kernel(law: SampledLaw, ports: int) -> Kernel:
    """The kernel that calls a law.

    A row of its table: where the new state is written, where the state is, its size, where the parameters are, their
    number, where the inputs are gathered, and of each input port where its numbers are and how many.

    Args:
        law: the law, which is compiled now.
        ports: number of input ports.
    """
    return Kernel(LAW.format(ports=ports, module=law.module.__name__), groups=(), turns=(), inputs=0)
