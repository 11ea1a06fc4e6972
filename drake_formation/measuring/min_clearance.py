"""Least distance between a robot and an obstacle."""

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.simulation.clearance import least_clearance


@metric("min_clearance_m", label="least distance to an obstacle", unit="m")
def min_clearance(transport: Transport) -> float | None:
    """From any robot's footprint to the edge of any obstacle, at any time (m); None without obstacles."""
    formation = transport.formation
    return least_clearance(transport.robots, transport.bulge, formation.obstacles, formation.footprints)
