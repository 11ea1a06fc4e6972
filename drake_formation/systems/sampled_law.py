"""Laws of blocks that look at times: what becomes of their discrete state, on plain arrays, as machine code.

A queue of packets or a table of measured delays takes indices and branches, which Drake's symbols do not know. Such a
law is an ordinary Python function that numba compiles; Drake's Simulator calls it through the block, and a
compiled diagram calls the same machine code, so that both do the same to the last bit.
"""

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation import machine_code

Array = NDArray[np.float64]

HEAD = """from __future__ import annotations

import math

import numpy as np
from numba import njit

floor, log, cos = math.floor, math.log, math.cos
"""
STEP = """

step = njit("void(float64, float64[::1], float64[::1], float64[::1])", error_model="numpy", cache=True)({name})
"""
"""Without fastmath: what is drawn and counted is exact."""


class SampledLaw:
    """The update of a block that has one periodic discrete update, which is carried out in place.

    ``law(time, inputs, state, numbers)`` takes the time (s), the values of all the block's input ports one after the
    other, its discrete state, which it changes, and its numeric parameters, each group after the other.

    Args:
        law: a function of arrays of floats, in the Python that numba compiles.
        helpers: the functions that it calls; those of :mod:`drake_formation.systems.random_stream` among them.
        constants: the numbers that they know by name.
    """

    def __init__(
        self, law: Callable[..., None], *helpers: Callable[..., Any], constants: Mapping[str, float] | None = None
    ) -> None:
        self._law, self._helpers, self._constants = law, helpers, constants or {}

    @cached_property
    def module(self) -> ModuleType:
        """The compiled module; its ``step`` is the law."""
        constants = "".join(f"{name} = {value!r}\n" for name, value in self._constants.items())
        helpers = [f"\n\n@njit(error_model='numpy')\n{inspect.getsource(helper)}" for helper in self._helpers]
        law = f"\n\n{inspect.getsource(self._law)}"
        return machine_code.load("".join([HEAD, constants, *helpers, law, STEP.format(name=self._law.__name__)]))

    def __call__(self, time: float, inputs: Array, state: Array, numbers: Array) -> None:
        """Carry the update out, as compiled."""
        self.module.step(time, inputs, state, numbers)

    def update(self, context: Any, ports: Sequence[Any], after: Any) -> None:
        """Carry the update of a block out: its callback of Drake's, but for the block itself.

        Args:
            context: the block's.
            ports: its input ports, all of them.
            after: its discrete values, which are written.
        """
        groups = range(context.num_discrete_state_groups())
        state = np.concatenate([context.get_discrete_state(k).CopyToVector() for k in groups])
        parameters = range(context.num_numeric_parameter_groups())
        numbers = [context.get_numeric_parameter(k).CopyToVector() for k in parameters]
        self(context.get_time(), np.concatenate([port.Eval(context) for port in ports]), state, np.concatenate(numbers))
        at = 0
        for k in groups:
            group = after.get_mutable_vector(k)
            group.SetFromVector(state[at : at + group.size()])
            at += group.size()
