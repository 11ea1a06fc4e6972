"""What comes and goes at a moment: hands that hold an object, crosses on robots that failed, pins where events were."""

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from pydrake.geometry import Box, Cylinder, Meshcat, Rgba, Sphere
from pydrake.math import RigidTransform, RotationMatrix

from drake_formation.simulation.events import HAND_OFF, Event
from drake_formation.viz import palette
from drake_formation.viz.playback import Playback
from drake_formation.viz.view.robots import RADIUS
from drake_formation.viz.view.solids import CARRYING_HEIGHT, TALKING_HEIGHT, Colour, Solid, opaque

Array = NDArray[np.float64]

MOST = 100
"""Pins that are drawn, of what happened first."""

RATE = 64
"""How often it is looked at what has changed (1/s)."""

ALARM: Colour = opaque(palette.ALARM)
HAND: Colour = (0.85, 0.62, 0.0, 1.0)
PIN = 0.9
"""Height of a pin (m)."""


class Marks:
    """All of them, drawn at once; when they are to be seen is recorded by :meth:`record`.

    Args:
        meshcat: where.
        bodies: path of the robots' frames, ``robot_1`` and so on.
        pins: path of the pins.
        playback: of the run.
    """

    def __init__(self, meshcat: Meshcat, bodies: str, pins: str, playback: Playback) -> None:
        self._meshcat, self._playback = meshcat, playback
        robots = [f"{bodies}/robot_{i + 1}" for i in range(playback.formation.robots)]
        self._hands = [f"{robot}/hand" for robot in robots] if playback.formation.has_body else []
        self._crosses = [f"{robot}/failed" for robot in robots] if playback.formation.stages else []
        self._pins = {f"{pins}/{k + 1}": event for k, event in enumerate(pinned(playback.events))}
        for path in self._hands:
            self._put(path, [Solid(Cylinder(0.05, 0.14), _at(0, 0, CARRYING_HEIGHT + 0.02), HAND)])
        for path in self._crosses:
            self._put(path, cross())
        for path, event in self._pins.items():
            self._put(path, pin(*event.place))

    def record(self) -> None:
        """Show hands while they hold, crosses while robots are out of order, and pins from when it happened."""
        self._switch(self._hands, self._playback.gripped)
        self._switch(self._crosses, self._playback.failed)
        for path, event in self._pins.items():
            self._meshcat.SetProperty(path, "visible", False, 0.0)
            self._meshcat.SetProperty(path, "visible", True, max(event.time - self._playback.begin, 0.0))

    def _switch(self, paths: list[str], told: Callable[[Array], NDArray[np.bool_]]) -> None:
        if not paths:
            return
        begin, end = self._playback.begin, self._playback.end
        times = np.append(np.arange(begin, end, 1 / RATE), end)
        for path, shown in zip(paths, told(times).T, strict=True):
            for k in [0, *(np.flatnonzero(np.diff(shown)) + 1).tolist()]:
                self._meshcat.SetProperty(path, "visible", bool(shown[k]), float(times[k] - begin))

    def _put(self, path: str, solids: Iterator[Solid] | list[Solid]) -> None:
        for k, solid in enumerate(solids):
            self._meshcat.SetObject(f"{path}/{k}", solid.shape, Rgba(*(solid.colour or ALARM)))
            self._meshcat.SetTransform(f"{path}/{k}", solid.pose)


def pinned(events: tuple[Event, ...]) -> list[Event]:
    """Of events those that have a pin."""
    return [event for event in events if event.kind != HAND_OFF][:MOST]


def cross() -> Iterator[Solid]:
    """Two bars across each other over a robot."""
    for angle in (-np.pi / 4, np.pi / 4):
        turned = RotationMatrix.MakeZRotation(angle)
        yield Solid(Box(3.2 * RADIUS, 0.09, 0.05), RigidTransform(turned, [0, 0, TALKING_HEIGHT + 0.05]), ALARM)


def pin(x: float, y: float) -> Iterator[Solid]:
    """A needle with a head that stands where something happened (m)."""
    yield Solid(Cylinder(0.012, PIN), _at(x, y, PIN / 2), ALARM)
    yield Solid(Sphere(0.07), _at(x, y, PIN), ALARM)


def _at(x: float, y: float, z: float) -> RigidTransform:
    return RigidTransform([x, y, z])
