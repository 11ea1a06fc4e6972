"""The figures by which a run is judged, each over the transport phase."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr

SETTLED = 0.02
"""A robot has settled when it stays within this share of the distance to the goal."""


@dataclass(frozen=True, kw_only=True)
class Metrics:
    """Figures of one run; None where there is nothing to measure.

    Attributes:
        tracking_error_m: for each robot the largest deviation from the obstacle-free response (m).
        consensus_error_m: largest consensus error of any robot (m) (paper, Eq. 19).
        peak_force_n: largest control force of any robot, springs excluded (N).
        min_clearance_m: least distance between a robot and an obstacle (m); None without obstacles.
        max_spring_strain: largest |d/r − 1| of any spring; None without springs.
        settling_time_s: time from the hand-off until every robot stays within 2 % of the distance to the goal about
            its slot there (s); None where that does not happen.
    """

    tracking_error_m: list[float]
    consensus_error_m: float
    peak_force_n: float
    min_clearance_m: float | None
    max_spring_strain: float | None
    settling_time_s: float | None

    def to_dict(self) -> dict[str, Any]:
        """The figures by name."""
        return asdict(self)


def metrics(result: xr.Dataset) -> Metrics:
    """Measure a result.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.

    Raises:
        ValueError: the result ends before the transport begins.
    """
    transport = result.isel(time=result["phase"].values == 1)
    if not transport.sizes["time"]:
        raise ValueError("the result has no transport phase to measure")
    strain = abs(transport["spring_length"] / transport["rest_length"] - 1)
    return Metrics(
        tracking_error_m=[float(x) for x in length(transport["deviation"]).max("time")],
        consensus_error_m=float(length(transport["consensus_error"]).max()),
        peak_force_n=float(length(transport["control_force"]).max()),
        min_clearance_m=float(transport["clearance"].min()) if transport.sizes["obstacle"] else None,
        max_spring_strain=float(strain.max()) if transport.sizes["spring"] else None,
        settling_time_s=settling_time(transport),
    )


def length(vectors: xr.DataArray) -> xr.DataArray:
    """Euclidean length over the axes, units kept."""
    with np.errstate(over="ignore"):  # a run that diverged may end in numbers whose squares overflow
        lengths: xr.DataArray = xr.apply_ufunc(
            np.linalg.norm, vectors, input_core_dims=[["axis"]], kwargs={"axis": -1}, keep_attrs=True
        )
    return lengths


def settling_time(transport: xr.Dataset) -> float | None:
    """Time from the start of a transport until every robot stays near its slot at the goal (s), or None."""
    travelled = float(length(transport["goal"] - transport["aggregation_centre"]))
    distance = length(transport["position"] - transport["slot"] - transport["goal"]).max("robot").values
    outside = np.flatnonzero(distance > SETTLED * travelled)
    time = transport["time"].values
    if not len(outside):
        return 0.0
    if outside[-1] == len(time) - 1:
        return None
    return float(time[outside[-1] + 1] - time[0])
