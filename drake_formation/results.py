"""Results in a notebook: read from where a run left them, and what ``result.formation`` adds to xarray's Dataset."""

from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

if TYPE_CHECKING:
    import pandas as pd

    from drake_formation.measuring import Metrics
    from drake_formation.scenario import Scenario
    from drake_formation.simulation.events import Event

RESULT = "result.nc"
"""What the file of a run's folder is called."""


def load_result(source: str | Path) -> xr.Dataset:
    """Read a result.

    Args:
        source: the folder of a run, or its ``result.nc``.

    Returns:
        The result as :func:`drake_formation.simulate` gives it.

    Raises:
        ValueError: it cannot be read.
    """
    from drake_formation.places import reason

    file = Path(source)
    if (file / RESULT).is_file():
        file = file / RESULT
    try:
        with xr.open_dataset(file, engine="netcdf4") as result:
            return result.load()
    except OSError as error:
        raise ValueError(f"{source}: cannot be read: {reason(error)}") from error


@xr.register_dataset_accessor("formation")  # type: ignore[no-untyped-call]
class FormationAccessor:
    """What this package knows of a result: ``result.formation``.

    A notebook shows it as the paths of the robots and the metrics. It is there for each result that this package made
    or read.

    Args:
        result: from :func:`drake_formation.simulate` or :func:`load_result`.
    """

    def __init__(self, result: xr.Dataset) -> None:
        self._result = result

    def __repr__(self) -> str:
        """The name of the run, and what it has: for where nothing better can be shown."""
        return f"<result of {self._result.attrs.get('title')}: scenario, metrics, events, to_dataframe, to_csv, …>"

    def _repr_html_(self) -> str:
        """What a notebook shows."""
        from drake_formation.display.result import result_html

        return result_html(self._result)

    @property
    def scenario(self) -> "Scenario":
        """What ran."""
        from drake_formation.simulation.result import series_of

        return series_of(self._result).scenario

    @property
    def metrics(self) -> "Metrics":
        """The figures by which the run is judged; see :func:`drake_formation.metrics`."""
        from drake_formation.measuring import metrics

        return metrics(self._result)

    @property
    def events(self) -> "tuple[Event, ...]":
        """What happened, in order of time."""
        from drake_formation.simulation.events import events

        return events(self._result)

    def to_dataframe(self, of: str = "robot") -> "pd.DataFrame":
        """One tidy table; see :func:`drake_formation.exporting.frame.to_dataframe`."""
        from drake_formation.exporting.frame import to_dataframe

        return to_dataframe(self._result, of)

    def to_csv(self, path: str | Path, of: str = "robot") -> None:
        """Write that table; see :func:`drake_formation.exporting.csv_file.write_csv`."""
        from drake_formation.exporting.csv_file import write_csv

        write_csv(self._result, path, of)

    def to_mat(self, path: str | Path) -> None:
        """Write a file for MATLAB; see :func:`drake_formation.exporting.mat_file.write_mat`."""
        from drake_formation.exporting.mat_file import write_mat

        write_mat(self._result, path)

    def to_mcap(self, path: str | Path) -> None:
        """Write a file for Foxglove; see :func:`drake_formation.exporting.mcap_file.write_mcap`."""
        from drake_formation.exporting.mcap_file import write_mcap

        write_mcap(self._result, path)

    def to_rrd(self, path: str | Path) -> None:
        """Write a file for Rerun; see :func:`drake_formation.exporting.rrd_file.write_rrd`."""
        from drake_formation.exporting.rrd_file import write_rrd

        write_rrd(self._result, path)
