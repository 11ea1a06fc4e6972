"""A result between its samples: where everything is at any time."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.scenario import resolve
from drake_formation.simulation.acting import acting, may_let_go
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.result import series_of
from drake_formation.viz.ages import ages

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

LATTICE = "lattice"
"""The kind of object that is a grid of nodes."""

OLD = 1.0
"""A channel over which nothing younger is known is taken for dead (s)."""

LOST = 20.0
"""Robots are shown as far off as this many times the size of the task; those of a run that diverged go beyond."""


class Playback:
    """A result as functions of time.

    Args:
        result: from :func:`drake_formation.simulate`, or read from ``result.nc``.

    Attributes:
        title: of the result.
        formation: what its scenario means.
        sensing_range: at which robots sense obstacles, from where they hold the object (m).
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
        self._result = result.isel(time=slice(shown))
        self._series = series_of(self._result)
        self._times = self._series["time"]
        self.title = str(result.attrs["title"])
        self.sensing_range = float(result.attrs["sensing_range_m"])
        if self.sensing_range:  # it begins at the footprint
            self.sensing_range += float(self.formation.footprints.max())
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

    def held(self, times: Array) -> NDArray[np.bool_]:
        """Whether each spring between robots holds them, shape (m, springs)."""
        carried = np.repeat(self.carried(times)[:, None], len(self.formation.springs.pairs), axis=1)
        if self.formation.has_body or not may_let_go(self.formation):
            return carried
        return carried & acting(self.formation, self._series.get("broken_at"), times)

    def alive(self, times: Array) -> NDArray[np.bool_]:
        """Whether each channel tells its robot something that is heeded and not old, shape (m, channels)."""
        formation = self.formation
        alive = np.ones((len(times), len(formation.channels.pairs)), dtype=bool)
        if "traffic" in self._result:
            told = [formation.channels.labels.index(str(label)) for label in self._result["channel"].values]
            alive[:, told] = ages(self._result, times).T <= OLD
        stage = np.searchsorted([stage.time for stage in formation.stages], times, "right") - 1
        for k, (i, j) in enumerate(formation.channels.pairs.tolist()):
            if (heard := formation.signals.get(f"heard_{i + 1}_{j + 1}")) is not None:
                alive[:, k] &= heard[stage, 0] == 1
        return alive

    def moved(self, times: Array) -> Array:
        """How far every obstacle has moved (m), shape (m, M, 2)."""
        return (
            self.formation.obstacles.displacements(times) if self.formation.obstacles else np.zeros((len(times), 0, 2))
        )

    def seen(self, places: Array) -> tuple[Array, Array]:
        """Corners of a rectangle about some places (m), shape (…, 2), the goal, and all obstacles with their range."""
        formation, obstacles = self.formation, self.formation.obstacles
        turns = np.array([self.begin, *np.clip(obstacles.turns, self.begin, self.end), self.end])
        outlines, reach = obstacles.outlines(turns), (obstacles.radii + self.sensing_range)[:, None, None]
        corners = [places, formation.goal + formation.slots, outlines - reach, outlines + reach]
        everything = np.concatenate([corner.reshape(-1, 2) for corner in corners])
        return np.nanmin(everything, axis=0), np.nanmax(everything, axis=0)

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
    task = np.concatenate([formation.starts, formation.goal + formation.slots, formation.obstacles.middles])
    middle, size = task.mean(axis=0), max(float(np.ptp(task, axis=0).max()), formation.radius, 1.0)
    off = np.abs(positions - middle).max(axis=(1, 2)) > LOST * size
    return max(int(off.argmax()), 1) if off.any() else len(positions)
