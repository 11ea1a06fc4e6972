"""The dataset of a sweep, written block by block: its size is bounded by the disk, not by memory."""

import csv
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
from numpy.typing import NDArray

from drake_formation.simulation.result import VARIABLES
from drake_formation.sweep.coordinates import Coordinate, coordinates, dimensions
from drake_formation.sweep.definition import Sweep
from drake_formation.sweep.quantities import metric_attributes
from drake_formation.sweep.schema import SERIES
from drake_formation.sweep.store import Store
from drake_formation.sweep.work import CODE, Outcome

FAILURES = "failures.csv"

MISSING, DONE, FAILED = 0, 1, 2
"""Values of ``status``."""

_BLOCK = 2_000_000
"""Numbers held in memory at once, roughly."""


def write_dataset(path: Path, sweep: Sweep, store: Store, made_with: dict[str, str]) -> None:
    """Write what a store holds as one NetCDF file, which appears when it is complete.

    Dimensions are the sweep's axes and, where a value has them, ``robot`` (from 1), ``time`` (s, from the beginning of
    a run) and ``axis`` (x, y). Variables are ``status`` (0 missing, 1 done, 2 failed), ``error`` (text), all metrics
    and the time series. Where runs have different numbers of robots or samples, what is beyond is NaN.

    Args:
        path: the file.
        sweep: the sweep.
        store: its runs.
        made_with: engine and versions, for the attributes.

    Raises:
        OSError, RuntimeError: the file cannot be written.
        SweepError: the store cannot be read.
    """
    partial = path.with_name(f".{path.name}.partial")
    try:
        _write(partial, sweep, store, made_with)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def _write(path: Path, sweep: Sweep, store: Store, made_with: dict[str, str]) -> None:
    shapes = store.shapes()
    with netCDF4.Dataset(path, "w") as file:
        file.set_fill_off()
        _write_attributes(file, sweep, made_with)
        swept = dimensions(sweep.axes)
        for name, size in zip(swept, sweep.shape, strict=True):
            file.createDimension(name, size)
        _write_inner_coordinates(file, sweep, shapes)
        for coordinate in coordinates(sweep.axes):
            _write_coordinate(file, coordinate)
        _create_variables(file, swept, sweep.shape, shapes)
        _refer_to_coordinates(file, [each.name for each in coordinates(sweep.axes) if each.name not in swept])
        numbers = max(1, sum(math.prod(shape) for shape in shapes.values()))
        for place, first, shape in blocks(sweep.shape, max(1, _BLOCK // numbers)):
            _write_block(file, place, first, shape, store, shapes)


def write_failures(folder: Path, sweep: Sweep, store: Store) -> None:
    """Write a table of the failed runs, what each sets and why it failed; none if there are none."""
    path = folder / FAILURES
    failures = store.failures()
    first = next(failures, None)
    if first is None:
        path.unlink(missing_ok=True)
        return
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(["point", "sets", "error"])
        for index, error in (first, *failures):
            sets = json.dumps(sweep.overrides(index), ensure_ascii=False)
            table.writerow([index, sets, error])


def blocks(shape: tuple[int, ...], most: int) -> Iterator[tuple[tuple[Any, ...], int, tuple[int, ...]]]:
    """A C-ordered array cut into contiguous blocks of at most so many points, in order.

    Yields:
        Where each block stands in the array, the number of its first point, and its shape.
    """
    inner = len(shape)
    while inner > 0 and math.prod(shape[inner - 1 :]) <= most:
        inner -= 1
    if inner == 0:
        yield (slice(None),) * len(shape), 0, shape
        return
    rest = math.prod(shape[inner:])
    step = max(1, most // rest)
    size = shape[inner - 1]
    for number, outer in enumerate(np.ndindex(shape[: inner - 1])):
        for begin in range(0, size, step):
            end = min(begin + step, size)
            place = (*outer, slice(begin, end), *[slice(None)] * (len(shape) - inner))
            yield place, (number * size + begin) * rest, (end - begin, *shape[inner:])


def _write_attributes(file: Any, sweep: Sweep, made_with: dict[str, str]) -> None:
    file.title = sweep.name
    file.description = sweep.description
    file.sweep = sweep.text
    file.base_scenario = json.dumps(sweep.base.data, ensure_ascii=False)
    file.engine = made_with["engine"]
    for name, value in made_with.items():
        if name not in ("sweep", "engine"):
            ending = "" if name == CODE else "_version"
            file.setncattr(f"{name.replace('-', '_')}{ending}", value)


def _write_inner_coordinates(file: Any, sweep: Sweep, shapes: dict[str, tuple[int, ...]]) -> None:
    inner = {
        name: size for value, shape in shapes.items() for name, size in zip(_inner(value, shape), shape, strict=True)
    }
    for name, size in inner.items():
        file.createDimension(name, size)
    if "robot" in inner:
        _write_coordinate(file, Coordinate("robot", "robot", np.arange(1, inner["robot"] + 1), {}))
    if "time" in inner and sweep.trajectories:
        times = sweep.trajectories.every * np.arange(inner["time"])
        attributes = {"units": "s", "long_name": "time since the beginning of the run"}
        _write_coordinate(file, Coordinate("time", "time", times, attributes))
    if "axis" in inner:
        _write_coordinate(file, Coordinate("axis", "axis", np.array(["x", "y"], dtype=object), {}))


def _write_coordinate(file: Any, coordinate: Coordinate) -> None:
    kind = str if coordinate.values.dtype == object else coordinate.values.dtype
    variable = file.createVariable(coordinate.name, kind, (coordinate.dimension,))
    variable[:] = coordinate.values
    variable.setncatts(coordinate.attributes)


def _create_variables(
    file: Any, swept: tuple[str, ...], sizes: tuple[int, ...], shapes: dict[str, tuple[int, ...]]
) -> None:
    status = file.createVariable("status", "i1", swept)
    status.setncatts(
        {
            "long_name": "what became of the run",
            "flag_values": np.array([MISSING, DONE, FAILED], dtype=np.int8),
            "flag_meanings": "missing done failed",
        }
    )
    file.createVariable("error", str, swept).long_name = "why the run failed"
    for name, shape in shapes.items():
        settings: dict[str, Any] = {"fill_value": np.nan}
        if name in SERIES:
            along = max(1, min(sizes[-1], 2**14 // math.prod(shape)))
            settings |= {"zlib": True, "complevel": 1, "chunksizes": (*[1] * (len(sizes) - 1), along, *shape)}
        variable = file.createVariable(name, "f8", (*swept, *_inner(name, shape)), **settings)
        if name in SERIES:
            _, variable.units, variable.long_name = VARIABLES[name]
        else:
            variable.setncatts(metric_attributes(name))


def _refer_to_coordinates(file: Any, names: list[str]) -> None:
    """By the CF conventions a variable names the coordinates that are not a dimension's own."""
    if not names:
        return
    for variable in file.variables.values():
        if set(file["status"].dimensions) <= set(variable.dimensions):
            variable.coordinates = " ".join(names)


def _inner(name: str, shape: tuple[int, ...]) -> tuple[str, ...]:
    """Dimensions that a value has of its own."""
    return ("time", "robot", "axis") if name in SERIES else ("robot",)[: len(shape)]


def _write_block(
    file: Any,
    place: tuple[Any, ...],
    first: int,
    shape: tuple[int, ...],
    store: Store,
    shapes: dict[str, tuple[int, ...]],
) -> None:
    count = math.prod(shape)
    status = np.full(count, MISSING, dtype=np.int8)
    errors = np.full(count, "", dtype=object)
    values = {name: np.full((count, *inner), np.nan) for name, inner in shapes.items()}
    for outcome in store.outcomes(first, first + count):
        k = outcome.index - first
        status[k] = DONE if outcome.error is None else FAILED
        errors[k] = outcome.error or ""
        _fill(values, k, outcome)
    file["status"][place] = status.reshape(shape)
    file["error"][place] = errors.reshape(shape)
    for name, array in values.items():
        file[name][place] = array.reshape(shape + shapes[name])


def _fill(values: dict[str, NDArray[np.float64]], k: int, outcome: Outcome) -> None:
    for name, value in outcome.values.items():
        corner: Any = (k, *(slice(size) for size in value.shape))
        values[name][corner] = value
