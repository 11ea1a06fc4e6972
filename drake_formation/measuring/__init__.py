"""The figures by which a run is judged, each over the transport phase, between its samples too.

One metric a file, such as ``consensus_error``, or a few of one kind, such as ``messages``. ``metric`` says what one is,
``transport`` what it looks at, ``registry`` which there are; ``control_law`` gives the control forces between samples.
"""

import warnings
from typing import TYPE_CHECKING

import numpy as np

from drake_formation.measuring.metric import Metric, Metrics, Value, metric
from drake_formation.sources import OWN

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray as xr

    from drake_formation.measuring.transport import Transport
    from drake_formation.simulation.series import Series

__all__ = ["Metric", "Metrics", "Value", "measure", "metric", "metrics", "register"]


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
    """Measure a run that is not labelled, by every metric there is.

    Args:
        series: from :meth:`drake_formation.simulation.PreparedRun.run`.

    Raises:
        ValueError: the run ends before the transport begins.
    """
    from drake_formation.measuring.registry import known
    from drake_formation.measuring.transport import Transport

    transport = Transport(series)
    with np.errstate(over="ignore", invalid="ignore"):  # a run that diverged may end in numbers whose squares overflow
        return Metrics(**{name: _measured(its, transport) for name, its in known().items()})


def measured_so_far(series: "Series") -> "Mapping[str, Value]":
    """As :func:`measure`, but of a run that ended before the transport began nothing."""
    return measure(series) if (series["phase"] == 1).any() else {}


def register(metric: Metric) -> Metric:
    """Make a metric known for this session; see :func:`drake_formation.measuring.registry.register`."""
    from drake_formation.measuring.registry import register as registered

    return registered(metric)


def _measured(metric: Metric, transport: "Transport") -> Value:
    """A metric's value. Another package's mistake costs its own figure, and not the run."""
    if metric.distribution == OWN:
        return metric(transport)
    try:
        return metric(transport)
    except Exception as error:
        reason = f"{type(error).__name__}: {error}"
        warnings.warn(f"metric {metric.name!r} of {metric.distribution} cannot be measured: {reason}", stacklevel=3)
        return None
