"""What the study keeps of a run: its metrics, and what else the paper's tables and claims ask for."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from drake_formation.measuring import Metrics, metrics
from drake_formation.scenario import Scenario, resolve
from drake_formation.vectors import length_of

Array = NDArray[np.float64]


def measured(scenario: Scenario, result: xr.Dataset) -> Metrics:
    """Figures of a run over its transport phase.

    Beside the metrics, in metres:

    - ``stacked_tracking_error_m``: largest norm of all robots' tracking errors together, the paper's ‖ε‖;
    - ``residual_m``: largest consensus error of the obstacle-free response: what the hand-off leaves;
    - ``disagreement_m``: largest consensus error of the deviation from that response: what obstacles cause;
    - ``deformation_m``: the same without what turns the formation;
    - ``turned_m`` and ``deformed_m``: at the moment of the largest consensus error, how far the formation's rotation
      moves a robot, and how far the rest does.

    Args:
        scenario: what ran.
        result: its result.
    """
    carried = result.isel(time=result["phase"].values == 1)
    slots = resolve(scenario).slots
    deviation, error = carried["deviation"].values, carried["consensus_error"].values
    caused = deviation - deviation.mean(axis=1, keepdims=True)
    worst = error[np.argmax(length_of(error).max(axis=1))]
    turned = rotation(worst, slots)
    return Metrics(
        **metrics(result),
        stacked_tracking_error_m=float(np.sqrt((deviation**2).sum(axis=(1, 2))).max()),
        residual_m=_largest(error - caused),
        disagreement_m=_largest(caused),
        deformation_m=_largest(caused - rotation(caused, slots)),
        turned_m=_largest(turned),
        deformed_m=_largest(worst - turned),
    )


def rotation(error: Array, slots: Array) -> Array:
    """The part of consensus errors that turns the formation, to first order (m), shape (..., N, 2).

    Args:
        error: of every robot (m), shape (..., N, 2).
        slots: slots about the formation centre (m), shape (N, 2).
    """
    arms = slots - slots.mean(axis=0)
    around = np.column_stack([-arms[:, 1], arms[:, 0]])
    angle = (error * around).sum(axis=(-2, -1), keepdims=True) / (around**2).sum()
    part: Array = angle * around
    return part


def _largest(vectors: Array) -> float:
    return float(length_of(vectors).max())
