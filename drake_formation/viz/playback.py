"""A result between its samples: where everything is at any time."""

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from drake_formation.formation.formation import Formation
from drake_formation.parts.roles import TRAFFIC
from drake_formation.scenario import resolve
from drake_formation.simulation.acting import acting, may_let_go
from drake_formation.simulation.events import Event, events
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
        self.sensing_range = self.formation.felt_within
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

    def gripped(self, times: Array) -> NDArray[np.bool_]:
        """Whether each robot's grip holds an object that is a body of its own, shape (m, N)."""
        held = acting(self.formation, self._series.get("grip_broken_at"), times)
        return self.carried(times)[:, None] & held

    def failed(self, times: Array) -> NDArray[np.bool_]:
        """Whether each robot is out of order: it does not actuate, or has dropped its load; shape (m, N)."""
        stages = self.formation.stages
        if not stages:
            return np.zeros((len(times), self.formation.robots), dtype=bool)
        sound = np.array([(stage.drive == 1) & (stage.held == 1) for stage in stages])
        return ~sound[self.stage(times)]

    def stage(self, times: Array) -> NDArray[np.intp]:
        """Which of the formation's stages it is, from 0; −1 where it has none."""
        return np.searchsorted([stage.time for stage in self.formation.stages], times, "right") - 1

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """What happened while it is shown, in order of time."""
        return tuple(event for event in events(self._result) if self.begin <= event.time <= self.end)

    @property
    def traffic(self) -> tuple[Array, Array, list[int]]:
        """What is recorded of packets: sample times (s), numbers of shape (samples, some, 6), and which channels."""
        if "traffic" not in self._series:
            return self._times, np.zeros((len(self._times), 0, len(TRAFFIC))), []
        labels = [str(label) for label in self._series["channel"]]
        return self._times, self._series["traffic"], [self.formation.channels.labels.index(label) for label in labels]

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
