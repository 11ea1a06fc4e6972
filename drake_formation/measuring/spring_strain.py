"""Largest strain of any spring."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.extremes import Vectors, longest, shortest

Array = NDArray[np.float64]


@metric("max_spring_strain", label="largest spring strain", unit="1")
def max_spring_strain(transport: Transport) -> float | None:
    """Largest share |d/r − 1| by which any spring is longer or shorter than at rest, or None without springs."""
    formation, bulge = transport.formation, transport.bulge
    first, second = formation.springs.pairs.T
    if not len(first):
        return None
    rest_lengths = formation.rest_lengths

    def lengths(position: Array) -> Array:
        apart: Array = (np.take(position, first, axis=-2) - np.take(position, second, axis=-2)) / rest_lengths[:, None]
        return apart

    shares = Vectors.of_positions(transport.robots, (bulge[:, first] + bulge[:, second]) / rest_lengths, lengths)
    return float(max(longest(shares)[0] - 1, 1 - shortest(shares)[0]))
