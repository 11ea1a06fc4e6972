"""Largest consensus error of any robot."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.extremes import Vectors, longest
from drake_formation.systems.consensus_error import consensus_errors


@metric("consensus_error_m", label="largest consensus error", unit="m")
def consensus_error(transport: Transport) -> float:
    """How far any robot is off its slot about the robots' own centre, at any time (m) (paper, Eq. 19)."""
    slots, bulge = transport.formation.slots, transport.bulge
    errors = Vectors.of_positions(
        transport.robots,
        bulge + bulge.mean(axis=1, keepdims=True),
        lambda position: consensus_errors(position, slots),
    )
    return float(longest(errors)[0])
