"""A result as comma-separated values."""

from pathlib import Path
from typing import TYPE_CHECKING

from drake_formation.exporting.frame import to_dataframe

if TYPE_CHECKING:
    import xarray as xr


def write_csv(result: "xr.Dataset", path: str | Path, of: str = "robot") -> None:
    """Write a result as a table: a line for every time and robot, every number in full, its unit in the heading.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        path: where.
        of: what has a line at every time; see :func:`drake_formation.exporting.frame.to_dataframe`.

    Raises:
        ExportError: the result has none of these.
        OSError: it cannot be written.
    """
    frame = to_dataframe(result, of)
    units = frame.attrs["units"]
    headings = {name: f"{name} ({unit})" for name, unit in units.items() if unit != "1"}
    frame.reset_index().rename(columns=headings).to_csv(path, index=False, encoding="utf-8")
