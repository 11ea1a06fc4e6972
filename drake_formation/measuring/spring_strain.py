"""Largest strain of any spring."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.acting import acting, may_let_go
from drake_formation.simulation.extremes import Vectors, longest, shortest
from drake_formation.simulation.series import BROKEN_AT
from drake_formation.vectors import length_of

Array = NDArray[np.float64]


@metric("max_spring_strain", label="largest spring strain", unit="1")
def max_spring_strain(transport: Transport) -> float | None:
    """Largest share |d/r − 1| by which any spring is longer or shorter than at rest, or None without springs.

    One that broke, or that a robot let go, counts as long as it held.
    """
    formation, bulge = transport.formation, transport.bulge
    first, second = formation.springs.pairs.T
    if not len(first):
        return None
    rest_lengths = formation.rest_lengths

    def lengths(position: Array) -> Array:
        apart: Array = (np.take(position, first, axis=-2) - np.take(position, second, axis=-2)) / rest_lengths[:, None]
        return apart

    bulges = (bulge[:, first] + bulge[:, second]) / rest_lengths
    if may_let_go(formation):
        shares = _while_acting(transport, bulges, lengths)
    else:
        shares = Vectors.of_positions(transport.robots, bulges, lengths)
    return float(max(longest(shares)[0] - 1, 1 - shortest(shares)[0]))


def _while_acting(transport: Transport, bulges: Array, lengths: Callable[[Array], Array]) -> Vectors:
    """Springs as shares of their length at rest, those that do not act as if they were at rest."""
    robots, broken_at = transport.robots, transport.series.get(BROKEN_AT[False])

    def law(times: Array, position: Array, _velocity: Array) -> Array:
        apart = lengths(position)
        at_rest = apart / length_of(apart)[..., None]  # in the same direction, so that none seems shorter on the way
        return np.where(acting(transport.formation, broken_at, times)[..., None], apart, at_rest)

    return Vectors(robots, law, law(robots.times, robots.position, robots.velocity), bulges)
