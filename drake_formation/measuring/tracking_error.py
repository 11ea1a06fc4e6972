"""Largest deviation from the obstacle-free response, for each robot."""

import numpy as np
from numpy.typing import NDArray

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.extremes import Vectors, longest


@metric("tracking_error_m", label="largest tracking error", unit="m", each=True)
def tracking_error(transport: Transport) -> NDArray[np.float64]:
    """How far each robot is off where it would be without obstacles, at any time (m)."""
    deviation = transport.deviation
    return longest(Vectors.of_positions(deviation, deviation.bulge()), each=True)
