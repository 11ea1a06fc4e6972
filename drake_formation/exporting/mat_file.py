"""A result for MATLAB."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from drake_formation.measuring import measured_so_far
from drake_formation.simulation.result import series_of

if TYPE_CHECKING:
    import xarray as xr


def write_mat(result: "xr.Dataset", path: str | Path) -> None:
    """Write a result as one struct, ``result``, which MATLAB and Octave load by ``load``.

    Its fields are the variables and coordinates of the result by their names, numbers as double and texts as cells;
    ``units`` and ``dimensions``, which have a field for each of them; ``metrics``, empty where there is nothing to
    measure, and without fields where the run ended before the transport; and ``attributes``, such as the whole scenario
    as YAML. Where robot 2 was first is ``result.position(1, 2, :)``.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.
        path: where; MATLAB wants it to end in .mat.

    Raises:
        ValueError, ScenarioError: it is not a result of this version.
        OSError: it cannot be written.
    """
    from scipy.io import savemat  # slow to import

    series = series_of(result)
    figures = measured_so_far(series)
    struct: dict[str, Any] = {str(name): _array(variable.values) for name, variable in result.variables.items()}
    struct["units"] = {str(name): v.attrs["units"] for name, v in result.variables.items() if "units" in v.attrs}
    struct["dimensions"] = {str(name): _cells(variable.dims) for name, variable in result.variables.items()}
    struct["metrics"] = {name: _metric(value) for name, value in figures.items()}
    struct["attributes"] = {str(name): value for name, value in result.attrs.items()}
    with Path(path).open("wb") as file:  # by itself SciPy says nothing of the file where it cannot be opened
        savemat(file, {"result": struct}, do_compression=True, long_field_names=True, oned_as="column")


def _array(values: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(values, dtype=float) if values.dtype.kind in "biuf" else _cells(values.tolist())


def _cells(texts: Any) -> NDArray[np.object_]:
    return np.array([str(text) for text in texts], dtype=object)


def _metric(value: float | list[float] | None) -> float | list[float]:
    return [] if value is None else value
