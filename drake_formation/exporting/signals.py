"""All numbers of a result over time, by topic, for programs that plot."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drake_formation.exporting.frame import OWNERS, TIME, numbers

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Signals:
    """Numbers over time.

    Attributes:
        topic: what they are of: letters, digits and ``_``, as all names here.
        units: of each number, by its name.
        times: of the samples (s), shape (samples,).
        values: shape (samples, numbers).
    """

    topic: str
    units: dict[str, str]
    times: Array
    values: Array


def signals(result: "xr.Dataset") -> Iterator[Signals]:
    """The signals of each robot, ``robot_1`` and so on, and of the ``formation``, its springs and channels.

    What belongs to obstacles or to nodes of the object alone is left out: the scene shows them.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
    """
    varying = result[[name for name, variable in result.data_vars.items() if TIME in variable.dims]]
    for robot in result["robot"].values.tolist():
        yield _signals(varying.sel(robot=robot), f"robot_{robot}", [v for v in varying if "robot" in varying[v].dims])
    of_time = [name for name in varying if not set(OWNERS) & set(varying[name].dims)]
    yield _signals(varying, "formation", of_time)
    for owner, topic in (("spring", "spring_numbers"), ("channel", "channel_numbers")):
        own = [name for name in varying if owner in varying[name].dims]
        if own and result.sizes[owner]:
            yield _signals(varying, topic, own)


def _signals(result: "xr.Dataset", topic: str, names: list[object]) -> Signals:
    units, columns = {}, []
    for name in names:
        variable = result[name]
        for column, unit, values in numbers(variable, [d for d in variable.dims if d != TIME]):
            units[re.sub(r"\W", "_", column)] = unit
            columns.append(np.asarray(values, dtype=float))
    return Signals(topic, units, result[TIME].values, np.column_stack(columns))
