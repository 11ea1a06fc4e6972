"""A result between its samples: where everything is at any time."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.scenario import resolve
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.result import series_of

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

LATTICE = "lattice"
"""The kind of object that is a grid of nodes."""

LOST = 20.0
"""Robots are shown as far off as this many times the size of the task; those of a run that diverged go beyond."""


class Playback:
    """A result as functions of time.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.

    Attributes:
        title: of the result.
        formation: what its scenario means.
        sensing_range: at which robots sense obstacles (m).
        begin: time of its first sample (s).
        end: time of the last one that is shown (s).
        lost: whether it goes on, but its robots were beyond all bounds then.

    Raises:
        ValueError: it is no result of this version, or has no sample.
        ScenarioError: its scenario is not one of this version.
    """

    def __init__(self, result: "xr.Dataset") -> None:
        whole = series_of(result)
        if not len(whole["time"]):
            raise ValueError("the result has no sample: there is nothing to show")
        self.formation: Formation = resolve(whole.scenario)
        if missing := [name for name in _expected(self.formation) if name not in whole]:
            raise ValueError(f"not a result of this version: it has no {', '.join(missing)}")
        shown = _before_lost(self.formation, whole["position"])
        self._series = series_of(result.isel(time=slice(shown)))
        self._times = self._series["time"]
        self.title = str(result.attrs["title"])
        self.sensing_range = float(result.attrs["sensing_range_m"])
        self.begin, self.end = float(self._times[0]), float(self._times[-1])
        self.lost = shown < len(whole["time"])
        motion = (self._series[name] for name in ("position", "velocity", "acceleration"))
        self._motion = Motion(self._times, *motion)

    def positions(self, times: Array) -> Array:
        """Where the robots are (m), at times of shape (m,): shape (m, N, 2)."""
        return self._motion.at_times(times)[0]

    def headings(self, times: Array) -> Array:
        """Headings of the robots (rad), zero for those that have none, shape (m, N)."""
        if "heading" not in self._series:
            return np.zeros((len(times), self.formation.robots))
        return self._between(times, np.nan_to_num(self._series["heading"]))

    def body(self, times: Array) -> Array:
        """Place and heading of an object that is a body of its own (m, rad), shape (m, 3)."""
        return self._between(times, self._series["object_pose"][:, :3])

    @property
    def nodes(self) -> int:
        """How many nodes the object has; none unless it is a grid."""
        return self._series["object_nodes"].shape[1] if "object_nodes" in self._series else 0

    def points(self, times: Array) -> Array:
        """Where the robots are, then the object's nodes (m), shape (m, N + nodes, 2)."""
        robots = self.positions(times)
        if not self.nodes:
            return robots
        nodes = self._series["object_nodes"].reshape(len(self._times), -1)
        return np.concatenate([robots, self._between(times, nodes).reshape(len(times), -1, 2)], axis=1)

    def carried(self, times: Array) -> NDArray[np.bool_]:
        """Whether the object is carried, shape (m,)."""
        carried: NDArray[np.bool_] = times >= self.formation.hand_off
        return carried

    def _between(self, times: Array, values: Array) -> Array:
        """Values at the samples, of shape (samples, columns), along straight lines between them."""
        return np.stack([np.interp(times, self._times, column) for column in values.T], axis=-1)


def _expected(formation: Formation) -> Iterator[str]:
    """What a result has beside what all have, by the kinds of robots and object."""
    if any(getattr(part, "has_heading", False) for part in formation.parts["robot"]):
        yield "heading"
    if formation.parts["object"][0].kind == LATTICE:
        yield "object_nodes"


def _before_lost(formation: Formation, positions: Array) -> int:
    """How many samples there are before a robot is lost; at least the first."""
    task = np.concatenate([formation.starts, formation.goal + formation.slots, formation.obstacles[:, :2]])
    middle, size = task.mean(axis=0), max(float(np.ptp(task, axis=0).max()), formation.radius, 1.0)
    off = np.abs(positions - middle).max(axis=(1, 2)) > LOST * size
    return max(int(off.argmax()), 1) if off.any() else len(positions)
