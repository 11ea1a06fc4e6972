"""How long the formation is lost."""

import numpy as np

from drake_formation.measuring.metric import metric
from drake_formation.measuring.transport import Transport
from drake_formation.vectors import length_of


@metric("outside_tolerance_s", label="time outside tolerance", unit="s")
def outside_tolerance(transport: Transport) -> float:
    """How long a robot's consensus error is above ``transport.tolerance`` (s); it changes evenly between samples."""
    beyond = length_of(transport["consensus_error"]).max(axis=-1) - transport.formation.tolerance
    first, last = beyond[:-1], beyond[1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = np.clip(np.maximum(first, last) / np.abs(last - first), 0.0, 1.0)
    share = np.where((first > 0) & (last > 0), 1.0, np.where((first > 0) | (last > 0), crossing, 0.0))
    return float(np.diff(transport["time"]) @ share)
