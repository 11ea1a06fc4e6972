"""The figures by which a run is judged, each over the transport phase, between its samples too."""

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

    from drake_formation.simulation.series import Series

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Metrics:
    """Figures of one run; None where there is nothing to measure.

    Attributes:
        tracking_error_m: for each robot the largest deviation from the obstacle-free response (m).
        consensus_error_m: largest consensus error of any robot (m) (paper, Eq. 19).
        peak_force_n: largest control force of any robot, springs excluded (N).
        min_clearance_m: least distance between a robot and an obstacle (m); None without obstacles.
        max_spring_strain: largest |d/r − 1| of any spring; None without springs.
        settling_time_s: time from the hand-off until every robot stays near its slot at the goal (s): within 2 % of
            the distance from where the formation gathers to the goal, or within a millimetre where that is more, as
            where it is carried nowhere; 0 where no robot is ever further off, None where one is at the end.
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
        ValueError: the result ends before the transport begins, or is none of this version.
        ScenarioError: its scenario is none of this version.
    """
    from drake_formation.simulation.result import series_of  # Drake is slow to import, as all that runs is

    return measure(series_of(result))


def measure(series: "Series") -> Metrics:
    """Measure a run that is not labelled.

    Args:
        series: from :meth:`drake_formation.simulation.PreparedRun.run`.

    Raises:
        ValueError: the run ends before the transport begins.
    """
    from drake_formation.simulation.measuring import measured

    return measured(series)


def length(vectors: "xr.DataArray") -> "xr.DataArray":
    """Euclidean length over the axes, units kept."""
    import xarray as xr  # slow to import, and not needed to build a diagram

    lengths: xr.DataArray = xr.apply_ufunc(length_of, vectors, input_core_dims=[["axis"]], keep_attrs=True)
    return lengths


def length_of(vectors: Array) -> Array:
    """Euclidean length over the last axis, x and y."""
    with np.errstate(over="ignore"):  # a run that diverged may end in numbers whose squares overflow
        lengths: Array = np.sqrt(vectors[..., 0] ** 2 + vectors[..., 1] ** 2)
    return lengths
