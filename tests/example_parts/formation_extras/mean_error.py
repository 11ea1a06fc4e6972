"""A metric: how far the robots are off their slots on the average."""

import numpy as np

from drake_formation.measuring import metric


@metric("mean_consensus_error_m", label="mean consensus error", unit="m", each=True)
def mean_error(transport):
    """For each robot the mean over time of its consensus error (m)."""
    error, time = np.linalg.norm(transport["consensus_error"], axis=-1), transport["time"]
    return np.trapezoid(error, time, axis=0) / (time[-1] - time[0])
