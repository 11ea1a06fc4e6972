"""Random numbers of which every part has a stream of its own, named by its place in the diagram.

The generator is L'Ecuyer's combination of two multiplicative generators (1988, *Communications of the ACM* 31(6),
Fig. 3; its period is 2.3e18). Its two whole numbers are discrete state of the block that draws, and all products stay
below 2^53, so that a stream is the same to the last bit in Drake's Simulator, in compiled code and in any process, and
whatever other parts a scenario has. The functions are plain arithmetic that floats and Expression share.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.systems.scalars import Scalar, cos, floor, log

Array = NDArray[np.float64]

MODULI = 2147483563, 2147483399
"""Of the two generators; both are prime."""


def random_start(seed: int, path: str) -> Array:
    """Where the stream of a part starts: the state of its generator, shape (2,).

    Args:
        seed: the scenario's.
        path: the part's place in the diagram, such as ``robot_1/sensor``.
    """
    drawn = np.random.SeedSequence(seed, spawn_key=tuple(path.encode())).generate_state(2, np.uint64)
    return np.array([float(1 + int(number) % (modulus - 1)) for number, modulus in zip(drawn, MODULI, strict=True)])


def advance(state: Scalar, multiplier: float, modulus: float) -> Scalar:
    """The next state of a multiplicative generator; the absolute value keeps Drake from multiplying it out."""
    product = multiplier * state
    return abs(product - modulus * floor(product / modulus))


def next_uniform(first: Scalar, second: Scalar) -> tuple[Scalar, Scalar, Scalar]:
    """A number between 0 and 1, both excluded, and the generator's next state.

    Args:
        first: first number of its state.
        second: second number of its state.
    """
    first, second = advance(first, 40014.0, 2147483563.0), advance(second, 40692.0, 2147483399.0)
    turns = (first - second) / 2147483562.0
    return turns - floor(turns) + 0.5 / 2147483562.0, first, second


def next_normal(state: Any) -> tuple[Scalar, list[Scalar]]:
    """A number of the standard normal distribution (Box & Muller 1958), and the generator's next state.

    Args:
        state: the state of a generator, two numbers.
    """
    near, first, second = next_uniform(*state)
    angle, first, second = next_uniform(first, second)
    return (-2.0 * log(near)) ** 0.5 * cos(2.0 * math.pi * angle), [first, second]
