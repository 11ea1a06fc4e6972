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
    velocity = transport["velocity"]
    ends = (transport.step_begins, velocity[:-1]), (transport["control_force"][1:], velocity[1:])
    begin, end, middle = (abs((u * v).sum(axis=-1)).sum(axis=-1) for u, v in (*ends, transport.half_way))
    return float(np.diff(times) @ (begin + 4 * middle + end) / 6)
