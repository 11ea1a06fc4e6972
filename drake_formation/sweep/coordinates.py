"""Names of a sweep's dimensions, and the labelled coordinates along them."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from drake_formation.config.errors import Fault
from drake_formation.sweep.axes import UNSET, Axis, text
from drake_formation.sweep.quantities import field_attributes, metric_names
from drake_formation.sweep.schema import SERIES

TAKEN = {"robot", "time", "axis", "status", "error", *metric_names(), *SERIES}
"""Names of other things in a sweep's dataset."""


@dataclass(frozen=True)
class Coordinate:
    """A coordinate along one dimension of a sweep.

    Attributes:
        name: the dimension's own name for the one by which positions are selected.
        dimension: name of the dimension.
        values: numbers, or texts where a value is not a number; one a position.
        attributes: ``kind`` of the axis, ``path`` of the swept field, ``units``, ``long_name``, ``scale`` (linear or
            log); those that there are.
    """

    name: str
    dimension: str
    values: np.ndarray[Any, Any]
    attributes: dict[str, str]


def dimensions(axes: Sequence[Axis]) -> tuple[str, ...]:
    """Name of each axis' dimension: its own, or that of its field."""
    names = _field_names(axes)
    return tuple(axis.name or names[next(iter(axis.columns))] for axis in axes)


def name_faults(axes: Sequence[Axis]) -> Iterator[Fault]:
    """Names of dimensions that stand for something else already, be it a field's coordinate."""
    names = _field_names(axes)
    others = Counter(names[path] for axis in axes if axis.kind != "grid" for path in axis.columns)
    seen = TAKEN | set(others)
    for axis, name in zip(axes, dimensions(axes), strict=True):
        if name in seen:
            yield Fault((*axis.place, "name"), "taken by another part of the dataset", name, "another name")
        seen = seen | {name}


def coordinates(axes: Sequence[Axis]) -> list[Coordinate]:
    """All coordinates of a sweep: for each dimension the one with its name, then those of the fields along it."""
    names = _field_names(axes)
    result = []
    for axis, dimension in zip(axes, dimensions(axes), strict=True):
        if axis.kind == "grid":
            path, column = next(iter(axis.columns.items()))
            attributes = field_attributes(path) | {"path": " ".join(axis.columns), "kind": "grid"} | _scale(axis, path)
            result.append(Coordinate(dimension, dimension, _array(axis.labels or column), attributes))
            continue
        labels = _array(axis.labels) if axis.labels else np.arange(1, len(axis) + 1)
        result.append(Coordinate(dimension, dimension, labels, {"kind": axis.kind, "long_name": dimension}))
        for path, column in axis.columns.items():
            if UNSET not in column:
                attributes = field_attributes(path) | _scale(axis, path)
                result.append(Coordinate(names[path], dimension, _array(column), attributes))
    return result


def _field_names(axes: Sequence[Axis]) -> dict[str, str]:
    """A short name for each swept field: the last key of its path if no other thing has that name, else the path."""
    short = {path: _short(path) for axis in axes for path in (*axis.columns,)}
    heads = [next(iter(axis.columns)) for axis in axes if axis.kind == "grid"]
    named = [axis.name for axis in axes if axis.name]
    alone = [path for axis in axes for path in axis.columns if axis.kind != "grid"]
    used = Counter([*named, *(short[path] for path in heads + alone)])
    return {path: path if used[name] > 1 or name in TAKEN else name for path, name in short.items()}


def _short(path: str) -> str:
    """The last key of a path, with the position in its list if it has one: ``stiffness``, ``mass.0``."""
    keys = path.split(".")
    last = max((k for k, key in enumerate(keys) if not key.isdecimal()), default=0)
    return ".".join(keys[last:])


def _scale(axis: Axis, path: str) -> dict[str, str]:
    return {"scale": axis.scale[path]} if path in axis.scale else {}


def _array(values: Sequence[Any]) -> np.ndarray[Any, Any]:
    """Numbers as such, everything else as text."""
    kinds = {type(value) for value in values}
    if kinds == {int} and all(abs(value) < 2**63 for value in values):
        return np.array(values, dtype=np.int64)
    if kinds <= {int, float} and float in kinds:
        return np.array([float(value) for value in values])
    return np.array([text(value) for value in values], dtype=object)
