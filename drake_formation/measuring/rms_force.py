"""Root mean square of the control forces."""

import numpy as np

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport


@metric("rms_force_n", label="RMS control force", unit="N")
def rms_force(transport: Transport) -> float | None:
    """√(mean over robots and time of ‖u‖²) (N), by Simpson's rule over the integrator's steps."""
    times = transport["time"]
    if len(times) < 2:
        return None
    begins, (middle, _), ends = transport.step_begins, transport.half_way, transport["control_force"][1:]
    squares = [(force**2).sum(axis=-1).mean(axis=-1) for force in (begins, middle, ends)]
    mean = np.diff(times) @ (squares[0] + 4 * squares[1] + squares[2]) / 6 / (times[-1] - times[0])
    return float(np.sqrt(mean))
