"""A sweep: a base scenario and axes; every point of it is a scenario of its own, found by its number."""

import hashlib
import json
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from drake_formation.scenario import Scenario, ScenarioError
from drake_formation.scenario.overrides import apply
from drake_formation.scenario.source import Document
from drake_formation.scenario.validate import validate
from drake_formation.sweep.axes import UNSET, Axis
from drake_formation.sweep.schema import Trajectories


@dataclass(frozen=True)
class Sweep:
    """A sweep, from :func:`drake_formation.sweep.load_sweep`.

    Points are numbered from 0, the last axis fastest, as in a C-ordered array over the axes.

    Attributes:
        name: short name.
        description: what it shows.
        text: the sweep file as it was read.
        base: the base scenario's data, overrides applied.
        axes: what varies.
        trajectories: time series to keep; None for none.
    """

    name: str
    description: str
    text: str
    base: Document
    axes: tuple[Axis, ...]
    trajectories: Trajectories | None

    def __len__(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of positions along each axis."""
        return tuple(len(axis) for axis in self.axes)

    def positions(self, index: int) -> tuple[int, ...]:
        """Position along each axis of a point."""
        return tuple(int(k) for k in np.unravel_index(index, self.shape))

    def overrides(self, index: int) -> dict[str, Any]:
        """What a point sets in the base scenario, by dotted path."""
        values: dict[str, Any] = {}
        for axis, position in zip(self.axes, self.positions(index), strict=True):
            values |= axis.overrides(position)
        return values

    def scenario(self, index: int) -> Scenario:
        """The scenario of a point.

        Raises:
            IndexError: there is no such point.
            ScenarioError: it is wrong.
        """
        if not 0 <= index < len(self):
            raise IndexError(f"sweep {self.name!r} has points 0 to {len(self) - 1}, not {index}")
        return point_scenario(self.base, self.overrides(index))

    def fingerprint(self) -> str:
        """Of everything that decides the runs: base, values and sampling, not names, labels or comments."""
        digest = hashlib.sha256()
        base = {key: value for key, value in self.base.data.items() if key not in ("name", "description")}
        kept = self.trajectories and self.trajectories.model_dump()
        digest.update(_canonical([base, kept]))
        for axis in self.axes:
            for path, column in sorted(axis.columns.items()):
                digest.update(_canonical([path, [["unset"] if value is UNSET else [0, value] for value in column]]))
            digest.update(b"axis")
        return digest.hexdigest()


def point_scenario(base: Document, overrides: dict[str, Any]) -> Scenario:
    """The scenario that overrides make of a base.

    Raises:
        ScenarioError: it is wrong.
    """
    try:
        return validate(apply(base, overrides))
    except ScenarioError as error:
        # The dotted path says which value it is; that an override brought it there goes without saying.
        origins = {f"overrides[{path!r}]" for path in overrides}
        faults = [replace(fault, origin="") if fault.origin in origins else fault for fault in error.faults]
        raise ScenarioError(faults) from error.__cause__


def probes(sweep: Sweep) -> Iterator[int]:
    """Points to check before anything runs: the first, and from there every position of one axis after another.

    They hold every value that was written down and the ends of every interval, so that a wrong path or value is found
    without building all points of a large sweep.
    """
    yield 0
    for k, axis in enumerate(sweep.axes):
        for position in axis.probes:
            if position:
                positions = [position if axis_index == k else 0 for axis_index in range(len(sweep.axes))]
                yield int(np.ravel_multi_index(positions, sweep.shape))


def _canonical(value: Any) -> bytes:
    return json.dumps(value, sort_keys=True, default=str).encode()
