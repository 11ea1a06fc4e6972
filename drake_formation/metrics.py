"""The figures by which a run is judged, each over the transport phase."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

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


def metrics(result: "xr.Dataset") -> Metrics:
    """Measure a result.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.

    Raises:
        ValueError: the result ends before the transport begins.
    """
    return measure({str(name): variable.values for name, variable in result.variables.items()})


def measure(series: Mapping[str, Array]) -> Metrics:
    """Measure a run that is not labelled.

    Args:
        series: variables of a labelled result as arrays, as :meth:`PreparedRun.run` gives them.

    Raises:
        ValueError: the run ends before the transport begins.
    """
    transport = series["phase"] == 1
    if not transport.any():
        raise ValueError("the result has no transport phase to measure")
    clearance, strain = series["clearance"][transport], series["spring_length"][transport] / series["rest_length"] - 1
    return Metrics(
        tracking_error_m=[float(x) for x in _length(series["deviation"][transport]).max(axis=0)],
        consensus_error_m=float(_length(series["consensus_error"][transport]).max()),
        peak_force_n=float(_length(series["control_force"][transport]).max()),
        min_clearance_m=float(clearance.min()) if clearance.size else None,
        max_spring_strain=float(abs(strain).max()) if strain.size else None,
        settling_time_s=_settling_time(series, transport),
    )


def length(vectors: "xr.DataArray") -> "xr.DataArray":
    """Euclidean length over the axes, units kept."""
    import xarray as xr  # slow to import, and not needed to build a diagram

    lengths: xr.DataArray = xr.apply_ufunc(_length, vectors, input_core_dims=[["axis"]], keep_attrs=True)
    return lengths


def _length(vectors: Array) -> Array:
    """Euclidean length over the last axis, x and y."""
    with np.errstate(over="ignore"):  # a run that diverged may end in numbers whose squares overflow
        lengths: Array = np.sqrt(vectors[..., 0] ** 2 + vectors[..., 1] ** 2)
    return lengths


def _settling_time(series: Mapping[str, Array], transport: NDArray[np.bool_]) -> float | None:
    """Time from the start of the transport until every robot stays near its slot at the goal (s), or None."""
    travelled = float(_length(series["goal"] - series["aggregation_centre"]))
    goals = series["slot"] + series["goal"]
    outside = np.flatnonzero(_length(series["position"][transport] - goals).max(axis=1) > SETTLED * travelled)
    time = series["time"][transport]
    if not len(outside):
        return 0.0
    if outside[-1] == len(time) - 1:
        return None
    return float(time[outside[-1] + 1] - time[0])
