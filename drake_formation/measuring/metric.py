"""A metric: one number of a run, or one of each of its robots, in a file of its own."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from drake_formation.sources import OWN

if TYPE_CHECKING:
    from drake_formation.measuring.transport import Transport

Value = float | list[float] | None
"""A number, one a robot, or None where there is nothing to measure."""
Measure = Callable[["Transport"], "ArrayLike | None"]


@dataclass(frozen=True)
class Metric:
    """What is measured of a run, and how.

    Attributes:
        name: by which it is known in ``metrics.json``, in sweeps and as an attribute of :class:`Metrics`; ends in its
            unit.
        label: what tables and figures call it.
        unit: of its values.
        each: whether every robot has a value.
        law: from the transport phase to a number, one a robot, or None where there is nothing to measure.
        distribution: the package that brings it.
    """

    name: str
    label: str
    unit: str
    each: bool
    law: Measure
    distribution: str = OWN

    @property
    def title(self) -> str:
        """What a table calls it that shows every robot's value."""
        return f"{self.label}, by robot" if self.each else self.label

    def __call__(self, transport: "Transport") -> Value:
        """Measure.

        Raises:
            ValueError: what the law gives is not what the metric says.
        """
        value = self.law(transport)
        if value is None:
            return None
        numbers = np.asarray(value, dtype=float)
        wanted = (transport.formation.robots,) if self.each else ()
        if numbers.shape != wanted:
            raise ValueError(f"its values have the shape {numbers.shape} instead of {wanted}")
        result: Value = numbers.tolist()
        return result


def metric(name: str, *, label: str, unit: str, each: bool = False) -> Callable[[Measure], Metric]:
    """Make a metric of a function: a decorator, which registers nothing yet.

    Args:
        name: see :class:`Metric`, as are the rest.
        label: what tables call it.
        unit: of its values.
        each: whether every robot has a value.
    """
    return lambda law: Metric(name, label, unit, each, law)


class Metrics(Mapping[str, Value]):
    """Figures of one run over its transport phase, by name and as attributes; None where there is nothing to measure.

    Those of this package, each defined in a module of :mod:`drake_formation.measuring`:

    Attributes:
        tracking_error_m: for each robot the largest deviation from the obstacle-free response (m).
        consensus_error_m: largest consensus error of any robot (m) (paper, Eq. 19).
        peak_force_n: largest control force of any robot, springs excluded (N).
        min_clearance_m: least distance between a robot and an obstacle (m); None without obstacles.
        max_spring_strain: largest |d/r − 1| of any spring; None without springs.
        max_object_strain: largest strain of an object that is a body of its own; None where it is springs.
        rms_force_n: root mean square of the control forces over robots and time (N).
        energy_j: ∫ Σ |u · v| dt of the control forces, driving and braking (J).
        outside_tolerance_s: how long a robot's consensus error is above ``transport.tolerance`` (s).
        messages_sent: packets sent over all channels; None, as the following, where no channel carries packets.
        messages_delivered: packets that arrived and were looked at.
        messages_lost: packets that were lost.
        messages_late: packets that came too late to be used.
        messages_overtaken: packets that a later one overtook.
        bit_rate_bps: bits sent a second.
        mean_age_s: mean age of information over time and channels (s).
        peak_age_s: largest age of information of any channel (s).
        settling_time_s: time from the hand-off until every robot stays near its slot at the goal (s).
    """

    def __init__(self, **values: Value) -> None:
        self._values = values

    def __getitem__(self, name: str) -> Value:
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._values:
            raise AttributeError(f"there is no metric {name!r}")
        return self._values[name]

    def __repr__(self) -> str:
        return f"Metrics({', '.join(f'{name}={value}' for name, value in self._values.items())})"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.result import metrics_html

        return metrics_html(self)

    def to_dict(self) -> dict[str, Value]:
        """The figures by name."""
        return dict(self._values)
