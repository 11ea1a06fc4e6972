"""Axes with their values worked out: positions along a dimension, and what each position sets."""

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from zlib import crc32

import numpy as np

from drake_formation.config.errors import Fault, Path, shown
from drake_formation.sweep.schema import AxisModel, Distribution, GridAxis, ListAxis, RandomAxis, ZipAxis

UNSET = object()
"""Stands in a column where a position leaves the base's value."""


@dataclass(frozen=True)
class Axis:
    """An axis of a sweep.

    Attributes:
        kind: grid, zip, list or random.
        name: name of its dimension; empty for a grid axis that takes its field's.
        columns: for each dotted path its values along the axis.
        labels: what to call the positions; None if their values, or their numbers, do.
        scale: ``linear`` or ``log`` where the spacing, or the distribution, of a path's values says so.
        probes: positions to check before anything runs.
        place: where it stands in the sweep file.
        source: the key under which its values stand there.
    """

    kind: str
    name: str
    columns: Mapping[str, Sequence[Any]]
    labels: tuple[str, ...] | None
    scale: Mapping[str, str]
    probes: Sequence[int]
    place: Path
    source: str

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def overrides(self, position: int) -> dict[str, Any]:
        """Values by dotted path at a position, from 0."""
        values = ((path, column[position]) for path, column in self.columns.items())
        return {path: value for path, value in values if value is not UNSET}

    def origin(self, position: int, path: str) -> Path:
        """Where in the sweep file the value of a path at a position was written, or the nearest place around it."""
        inside: dict[str, Path] = {
            "grid": (position,),
            "zip": (path, position),
            "list": (position, "set", path),
            "random": (path,),
        }
        return (*self.place, self.source, *inside[self.kind])


def resolve(model: AxisModel, place: Path) -> tuple[Axis | None, list[Fault]]:
    """An axis from its model, or what is wrong with it.

    Args:
        model: as the user wrote it.
        place: where it stands in the sweep file.
        source: the key under which its values stand there.
    """
    faults = list(_CHECKS[model.kind](model, place))
    return (None, faults) if faults else (_MAKERS[model.kind](model, place), [])


def extent(model: AxisModel) -> tuple[int, int, str]:
    """How large an axis would be: its positions, the fields along it, and the key that says so; nothing is made."""
    match model:
        case GridAxis():
            counts = {"values": len(model.values or ())}
            counts |= {name: steps[2] for name in ("linspace", "logspace") if (steps := getattr(model, name))}
            source = max(counts, key=counts.__getitem__)
            return counts[source], 1, source
        case ZipAxis():
            return max(map(len, model.values.values())), len(model.values), "values"
        case ListAxis():
            return len(model.points), len({path for point in model.points for path in point.set}), "points"
        case RandomAxis():
            return model.count, len(model.draw), "count"


def text(value: Any) -> str:
    """What to call a value: names as they are, everything else as in YAML's flow style."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=str)


def _grid(model: GridAxis, place: Path) -> Axis:
    paths = [model.path] if isinstance(model.path, str) else model.path
    scale, values = "linear", list(model.values or ())
    if model.linspace:
        values = np.linspace(*model.linspace).tolist()
    if model.logspace:
        scale, values = "log", np.geomspace(*model.logspace).tolist()
    probes = range(len(values)) if model.values else (0, len(values) - 1)
    scales = dict.fromkeys(paths, scale) if model.values is None else {}
    source = next(name for name in ("values", "linspace", "logspace") if getattr(model, name))
    return Axis("grid", model.name or "", dict.fromkeys(paths, values), model.labels, scales, probes, place, source)


def _zip(model: ZipAxis, place: Path) -> Axis:
    count = len(next(iter(model.values.values())))
    return Axis("zip", model.name, model.values, model.labels, {}, range(count), place, "values")


def _list(model: ListAxis, place: Path) -> Axis:
    paths = dict.fromkeys(path for point in model.points for path in point.set)
    columns = {path: [point.set.get(path, UNSET) for point in model.points] for path in paths}
    labels = tuple(point.label for point in model.points)
    return Axis("list", model.name, columns, labels, {}, range(len(labels)), place, "points")


def _random(model: RandomAxis, place: Path) -> Axis:
    columns = {path: draws(model.seed, path, one, model.count) for path, one in model.draw.items()}
    scale = {path: "log" if one.loguniform else "linear" for path, one in model.draw.items()}
    # A distribution with tails may well draw what is not allowed: those runs fail, the sweep is not refused.
    return Axis("random", model.name, columns, None, scale, (0,), place, "draw")


def draws(seed: int, path: str, distribution: Distribution, count: int) -> list[Any]:
    """Samples of one field, the first ones the same for every count."""
    rng = np.random.default_rng([seed, crc32(path.encode())])
    values: np.ndarray[Any, Any]
    match distribution:
        case Distribution(uniform=(low, high)):
            values = rng.uniform(low, high, count)
        case Distribution(loguniform=(low, high)):
            values = np.exp(rng.uniform(np.log(low), np.log(high), count))
        case Distribution(normal=(mean, deviation)):
            values = rng.normal(mean, deviation, count)
        case Distribution(integers=(low, high)):
            values = rng.integers(low, high, count, endpoint=True)
    return list(values.tolist())


def _check_grid(model: GridAxis, place: Path) -> Iterator[Fault]:
    sources = {"values": model.values, "linspace": model.linspace, "logspace": model.logspace}
    given = [name for name, source in sources.items() if source is not None]
    if len(given) != 1:
        message = f"{' and '.join(given)} given" if given else "without values"
        yield Fault(place, message, allowed="one of values, linspace, logspace")
        return
    if model.logspace and min(model.logspace[:2]) <= 0:
        yield Fault((*place, "logspace"), "out of range", shown(model.logspace), "first and last > 0")
    paths = [model.path] if isinstance(model.path, str) else list(model.path)
    yield from _unique(paths, (*place, "path"))
    if model.values:
        yield from _unique(list(model.values), (*place, "values"))
    steps = model.linspace or model.logspace
    if model.linspace:
        yield from _check_difference(*model.linspace[:2], (*place, "linspace"))
    if steps and steps[2] > 1 and steps[0] == steps[1]:
        yield Fault((*place, given[0]), "all values are the same", shown(steps), "first and last that differ")
    yield from _check_labels(model.labels, steps[2] if steps else len(model.values or ()), place)


def _check_zip(model: ZipAxis, place: Path) -> Iterator[Fault]:
    counts = {path: len(values) for path, values in model.values.items()}
    if len(set(counts.values())) > 1:
        found = ", ".join(f"{count} of {path}" for path, count in counts.items())
        yield Fault((*place, "values"), f"not equally many values: {found}")
        return
    yield from _check_labels(model.labels, max(counts.values()), place)


def _check_list(model: ListAxis, place: Path) -> Iterator[Fault]:
    yield from _unique([point.label for point in model.points], (*place, "points"))
    if not any(point.set for point in model.points):
        yield Fault((*place, "points"), "nothing is set", allowed="at least one point that sets a field")


def _check_random(model: RandomAxis, place: Path) -> Iterator[Fault]:
    for path, one in model.draw.items():
        here = (*place, "draw", path)
        given = [name for name in Distribution.model_fields if getattr(one, name) is not None]
        if len(given) != 1:
            message = f"{' and '.join(given)} given" if given else "no distribution"
            yield Fault(here, message, allowed=f"one of {', '.join(Distribution.model_fields)}")
            continue
        first, second = getattr(one, given[0])
        shown_values = shown([first, second])
        if given[0] == "normal":
            if second < 0:
                yield Fault((*here, "normal"), "out of range", shown_values, "a standard deviation >= 0")
        elif first > second or (given[0] == "loguniform" and first <= 0):
            allowed = "0 < low <= high" if given[0] == "loguniform" else "low <= high"
            yield Fault((*here, given[0]), "out of range", shown_values, allowed)
        elif given[0] == "uniform":
            yield from _check_difference(first, second, (*here, "uniform"))
        elif given[0] == "integers" and not -(2**63) <= first <= second < 2**63:
            yield Fault((*here, given[0]), "out of range", shown_values, "integers of 64 bits")


def _check_difference(first: float, last: float, place: Path) -> Iterator[Fault]:
    if not math.isfinite(last - first):
        yield Fault(place, "out of range", shown([first, last]), "numbers whose difference is one")


def _check_labels(labels: tuple[str, ...] | None, count: int, place: Path) -> Iterator[Fault]:
    if labels is None:
        return
    if len(labels) != count:
        yield Fault((*place, "labels"), f"{len(labels)} labels for {count} positions")
    yield from _unique(list(labels), (*place, "labels"))


def _unique(values: list[Any], place: Path) -> Iterator[Fault]:
    """A fault for every value that stands twice: it could not be told from the other in the dataset."""
    seen: set[Any] = set()
    for position, value in enumerate(values):
        key = value if isinstance(value, int | float) else text(value)
        if key in seen:
            yield Fault((*place, position), "given twice", shown(value))
        seen.add(key)


_MAKERS: dict[str, Callable[[Any, Path], Axis]] = {"grid": _grid, "zip": _zip, "list": _list, "random": _random}
_CHECKS: dict[str, Callable[[Any, Path], Iterator[Fault]]] = {
    "grid": _check_grid,
    "zip": _check_zip,
    "list": _check_list,
    "random": _check_random,
}
