"""What the obstacles of a simulated run did, against what the linearized loop promises for such forces."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from drake_formation.analysis.linear.linearization import LinearFormation
from drake_formation.analysis.linear.norms import StateSpace
from drake_formation.analysis.response.disturbance import force_to_error
from drake_formation.analysis.response.impulse_peak import impulse_peaks
from drake_formation.vectors import length

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ObstacleEffect:
    """The obstacles' own part of the consensus error of a run.

    It is measured on the deviation from the obstacle-free response, so that what was left at the hand-off is no part
    of it. The run's recorded forces are taken as given: the bound holds for them, not for other paths, on which the
    avoidance force would be another.

    Attributes:
        impulses_ns: total impulse ∫ ‖f‖ dt of the avoidance force on every robot (N s).
        bound_m: the largest error that forces of these impulses could cause in the linearized loop (m).
        driven_m: the largest error of the linearized loop driven by the recorded forces (m).
        observed_m: the largest error in the run (m).
    """

    impulses_ns: list[float]
    bound_m: float
    driven_m: float
    observed_m: float

    def to_dict(self) -> dict[str, Any]:
        """Plain values by name."""
        return asdict(self)


def obstacle_effect(formation: LinearFormation, result: xr.Dataset) -> ObstacleEffect:
    """Compare a run with the linearized loop.

    Args:
        formation: the linearization of the scenario that ran.
        result: from :func:`drake_formation.simulate`, with a transport of two samples or more.

    Raises:
        IllPosedError: there is one robot only, or the loop is not stable.
        ValueError: the result is of another number of robots, or has no transport.
    """
    from scipy.integrate import trapezoid

    carried = result.isel(time=result["phase"].values == 1)
    if carried.sizes["time"] < 2 or carried.sizes["robot"] != formation.robots:
        raise ValueError("the result must have a transport phase, and as many robots as the formation")
    system = force_to_error(formation, formation.delta, formation.delta_v)
    times = carried["time"].values
    force = carried["avoidance_force"].transpose("time", "robot", "axis").values
    impulses = trapezoid(np.linalg.norm(force, axis=-1), times, axis=0)
    deviation = carried["deviation"]
    return ObstacleEffect(
        impulses_ns=impulses.tolist(),
        bound_m=float(impulse_peaks(system).bound @ impulses),
        driven_m=float(np.linalg.norm(driven_error(formation, times, force)[1], axis=-1).max()),
        observed_m=float(length(deviation - deviation.mean("robot")).max()),
    )


def driven_error(formation: LinearFormation, times: Array, force: Array) -> tuple[Array, Array]:
    """Consensus errors of the linearized loop, from rest, under forces on its robots.

    Args:
        formation: the linearized formation.
        times: ascending (s), shape (samples,); forces are taken as linear between them.
        force: on every robot (N), shape (samples, N, 2).

    Returns:
        Even times (s), shape (T,), fine enough for the fastest mode; and e (m), shape (T, N, 2).
    """
    from scipy.signal import lsim

    system: StateSpace = force_to_error(formation, formation.delta, formation.delta_v)
    step = 0.2 / np.abs(np.linalg.eigvals(system.A)).max()
    even = np.linspace(times[0], times[-1], int(np.ceil((times[-1] - times[0]) / step)) + 1)
    inputs = np.column_stack([np.interp(even, times, column) for column in force.reshape(len(times), -1).T])
    none = np.zeros((len(system.C), system.B.shape[1]))
    _, errors, _ = lsim((*system, none), inputs, even - even[0])
    return even, np.reshape(errors, (len(even), formation.robots, 2))
