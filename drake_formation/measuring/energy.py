"""Work that the robots' actuators do."""

import numpy as np

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport


@metric("energy_j", label="energy, driving and braking", unit="J")
def energy(transport: Transport) -> float | None:
    """∫ Σ_i |u_i · v_i| dt (J), by Simpson's rule over the integrator's steps: braking costs as much as driving."""
    times = transport["time"]
    if len(times) < 2:
        return None
    force, velocity = transport["control_force"], transport["velocity"]
    powers = [abs((u * v).sum(axis=-1)).sum(axis=-1) for u, v in ((force, velocity), transport.half_way)]
    return float(np.diff(times) @ (powers[0][:-1] + 4 * powers[1] + powers[0][1:]) / 6)
