"""The metrics there are: those of this package, those of installed ones, and those that a session registers."""

import functools
import importlib
import pkgutil
import threading
import warnings
from dataclasses import replace
from importlib.metadata import EntryPoint, entry_points

from drake_formation.measuring.metric import Metric
from drake_formation.sources import METRIC_POINTS, SESSION

_FINDING = threading.RLock()
_metrics: dict[str, Metric] = {}


class MetricError(TypeError):
    """A metric that cannot be used, with its name and where it comes from."""


def known() -> dict[str, Metric]:
    """All metrics by name, this package's first, in alphabetical order."""
    with _FINDING:
        _find_all()
        return dict(_metrics)


def register(metric: Metric) -> Metric:
    """Make a metric known for this session, as a notebook does; a decorator, or called with the metric.

    One of the same name that this session registered before is replaced, so that a cell may run again.

    Raises:
        MetricError: it is no metric, or has the name of one that an installed package brings.
    """
    _require_metric(metric, SESSION)
    earlier = known().get(metric.name)
    if earlier and earlier.distribution != SESSION:
        raise MetricError(f"{earlier.distribution} has a metric {metric.name!r}; give yours another name")
    _metrics[metric.name] = replace(metric, distribution=SESSION)
    return _metrics[metric.name]


@functools.cache
def _find_all() -> None:
    import drake_formation.measuring as package

    for module in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
        for value in vars(importlib.import_module(module.name)).values():
            if isinstance(value, Metric):
                _metrics[value.name] = value
    for entry in entry_points(group=METRIC_POINTS):
        _load(entry)


def _load(entry: EntryPoint) -> None:
    """Take in a metric of an installed package; one that cannot be used is told of, and the others are."""
    distribution = entry.dist.name if entry.dist else entry.value
    try:
        metric = entry.load()
        _require_metric(metric, distribution)
        _require_free(metric.name)
        _metrics[metric.name] = replace(metric, distribution=distribution)
    except Exception as error:  # whatever another package raises is its own
        warnings.warn(f"metric {entry.name!r} of {distribution} cannot be used: {error}", stacklevel=2)


def _require_free(name: str) -> None:
    if name in _metrics:
        raise MetricError(f"{_metrics[name].distribution} has a metric {name!r} too; remove one of them")


def _require_metric(metric: object, distribution: str) -> None:
    if not isinstance(metric, Metric):
        name = getattr(metric, "__name__", repr(metric))
        raise MetricError(
            f"{name!r} of {distribution} is no metric: a function with @metric(name, label=…, unit=…) is one"
        )
