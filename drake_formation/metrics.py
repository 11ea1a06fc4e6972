"""The figures by which a run is judged, each over the transport phase, between its samples too."""

from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation import graphs
from drake_formation.parameters import block_parameters
from drake_formation.scenario import Scenario, derive
from drake_formation.simulation.clearance import least_clearance
from drake_formation.simulation.extremes import Vectors, last_beyond, longest, shortest
from drake_formation.simulation.laws import ControlLaw
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.result import series_of
from drake_formation.simulation.series import Series
from drake_formation.systems.consensus_error import consensus_errors

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

SETTLED = 0.02
"""A robot has settled when it stays within this share of the distance to the goal."""
SETTLED_AT_LEAST = 1e-3
"""It need not come nearer than this (m), also where the goal is where the formation is already."""


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
    return measure(series_of(result))


def measure(series: Series) -> Metrics:
    """Measure a run that is not labelled.

    Args:
        series: from :meth:`drake_formation.simulation.PreparedRun.run`.

    Raises:
        ValueError: the run ends before the transport begins.
    """
    transport = series["phase"] == 1
    if not transport.any():
        raise ValueError("the result has no transport phase to measure")
    scenario = series.scenario
    with np.errstate(over="ignore", invalid="ignore"):  # as in lengths
        robots = _motion(series, transport, "position", "velocity", "acceleration")
        deviation = _motion(series, transport, "deviation", "deviation_velocity", "deviation_acceleration")
        bulge = robots.bulge()
        return Metrics(
            tracking_error_m=[float(x) for x in longest(Vectors.of_positions(deviation, deviation.bulge()), each=True)],
            consensus_error_m=float(longest(_consensus_errors(robots, bulge, series["slot"]))[0]),
            peak_force_n=float(longest(_control_forces(robots, series["control_force"][transport], scenario))[0]),
            min_clearance_m=least_clearance(robots, bulge, series["obstacle_position"], series["obstacle_radius"]),
            max_spring_strain=_strain(
                robots, bulge, graphs.edges(derive.spring_graph(scenario)), series["rest_length"]
            ),
            settling_time_s=_settling_time(robots, bulge, series),
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


def _motion(series: Series, samples: NDArray[np.bool_], *names: str) -> Motion:
    return Motion(series["time"][samples], *(series[name][samples] for name in names))


def _consensus_errors(robots: Motion, bulge: Array, slots: Array) -> Vectors:
    return Vectors.of_positions(
        robots, bulge + bulge.mean(axis=1, keepdims=True), lambda position: consensus_errors(position, slots)
    )


def _control_forces(robots: Motion, recorded: Array, scenario: Scenario) -> Vectors:
    """Control forces as recorded (N), and by the blocks' laws in between.

    They have no second derivatives to go by. A step's chord is taken to be left by twice what it is half-way.
    """
    law = ControlLaw(scenario, block_parameters(scenario))
    steps = np.arange(len(robots.times) - 1)
    position, velocity, _ = robots.at(steps, np.full((len(steps), 1), 0.5))
    middle = law(0.5 * (robots.times[:-1] + robots.times[1:]), position[:, 0], velocity[:, 0])
    return Vectors(robots, law, recorded, _length(recorded[:-1] - 2 * middle + recorded[1:]))


def _strain(robots: Motion, bulge: Array, springs: list[tuple[int, int]], rest_lengths: Array) -> float | None:
    """Largest share by which any spring is longer or shorter than at rest, or None."""
    if not springs:
        return None
    first, second = [i for i, _ in springs], [j for _, j in springs]

    def lengths(position: Array) -> Array:
        return (position[..., first, :] - position[..., second, :]) / rest_lengths[:, None]

    shares = Vectors.of_positions(robots, (bulge[:, first] + bulge[:, second]) / rest_lengths, lengths)
    return float(max(longest(shares)[0] - 1, 1 - shortest(shares)[0]))


def _settling_time(robots: Motion, bulge: Array, series: Series) -> float | None:
    """Time from the start of the transport until every robot stays near its slot at the goal (s), or None."""
    travelled = float(_length(series["goal"] - series["aggregation_centre"]))
    goals = series["slot"] + series["goal"]
    short = Vectors.of_positions(robots, bulge, lambda position: position - goals)
    last = last_beyond(short, max(SETTLED * travelled, SETTLED_AT_LEAST))
    if last is None:
        return 0.0
    step, share = last
    if step == len(robots.times) - 1:
        return None
    return float(robots.times[step] + share * (robots.times[step + 1] - robots.times[step]) - robots.times[0])
