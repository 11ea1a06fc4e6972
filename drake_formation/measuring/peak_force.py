"""Largest control force of any robot."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.extremes import Vectors, longest
from drake_formation.vectors import length_of


@metric("peak_force_n", label="peak control force", unit="N")
def peak_force(transport: Transport) -> float:
    """The control force as recorded, and by the blocks' laws in between; springs are not part of it (N)."""
    robots, recorded = transport.robots, transport["control_force"]
    middle, _ = transport.half_way
    # Forces have no second derivatives to go by: a step's chord is taken to be left by twice what it is half-way.
    bulge = length_of(transport.step_begins - 2 * middle + recorded[1:])
    return float(longest(Vectors(robots, transport.law, recorded, bulge))[0])
