"""A result as a tidy table: a row for every time and robot, a column for every number."""

from collections.abc import Hashable, Iterator
from itertools import product
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drake_formation.exporting.errors import ExportError

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

OWNERS = ("robot", "spring", "obstacle", "channel", "node")
"""What numbers of a result belong to, one of which a table has rows of."""

TIME = "time"
"""What a table has rows of where it is of what belongs to none of them."""

MANY_UNITS = {"object_pose": ("m", "m", "rad", "m/s", "m/s", "rad/s"), "traffic": ("1", "1", "1", "1", "1", "s")}
"""Units of the columns of a variable whose columns differ in them."""


def to_dataframe(result: "xr.Dataset", of: str = "robot") -> "pd.DataFrame":
    """A result as one tidy table; xarray's own of the whole result has a row for every pairing of everything.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        of: what has a row at every time: ``robot``, ``spring``, ``obstacle``, ``channel``, ``node``; or ``time``, for
            what belongs to none of these.

    Returns:
        A row for each time (s) and owner, its index, in this order. A column for each number that belongs to the owner,
        such as ``position_x`` or ``clearance_obstacle_1``, or to the time alone, such as ``phase``. Units are in
        ``frame.attrs["units"]``, by column.

    Raises:
        ExportError: the result has none of these.
    """
    import pandas as pd  # slow to import

    there = [TIME, *(owner for owner in OWNERS if result.sizes.get(owner))]
    if of not in there:
        raise ExportError(f"the result has no rows of {of!r}; it has those of {', '.join(there)}")
    rows = tuple(dict.fromkeys((TIME, of)))
    columns, units = {}, {}
    for variable in result.data_vars.values():
        if of not in (owners := set(OWNERS) & set(variable.dims)) and (owners or TIME not in variable.dims):
            continue
        spread = [dimension for dimension in variable.dims if dimension not in rows]
        for column, unit, values in numbers(variable, spread):
            shape = [result.sizes[row] for row in rows]
            missing = [axis for axis, row in enumerate(rows) if row not in variable.dims]
            columns[column] = np.broadcast_to(np.expand_dims(values, missing), shape).ravel()
            units[column] = unit
    index = [pd.Index(result[row].values, name=row) for row in rows]
    frame = pd.DataFrame(columns, index=index[0] if len(index) == 1 else pd.MultiIndex.from_product(index))
    frame.attrs["units"] = {TIME: "s"} | units
    return frame


def numbers(variable: "xr.DataArray", spread: list[Hashable]) -> Iterator[tuple[str, str, NDArray[np.float64]]]:
    """A variable as columns.

    Args:
        variable: of a result.
        spread: its dimensions of which every label has a column.

    Yields:
        The column's name, its unit, and its values, of the dimensions that are left, in their order.
    """
    labels = [variable[dimension].values.tolist() for dimension in spread]
    units = MANY_UNITS.get(str(variable.name))
    for chosen in product(*(range(len(of)) for of in labels)):
        called = (_called(*place) for place in zip(spread, labels, chosen, strict=True))
        unit = units[chosen[-1]] if units else str(variable.attrs.get("units", "1"))
        column = variable.isel(dict(zip(spread, chosen, strict=True)))
        yield "_".join([str(variable.name), *called]), unit, column.values


def _called(dimension: Hashable, labels: list[object], number: int) -> str:
    """What a label adds to the name of a column: itself, and of what it is where that it does not say."""
    if dimension in OWNERS or dimension == "vertex":
        label = labels[number] if dimension in OWNERS else number + 1
        return f"{dimension}_{label}"
    return str(labels[number])
