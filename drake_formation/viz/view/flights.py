"""Packets that fly from who speaks to who hears: balls, each of which is one packet after the other."""

import heapq

import numpy as np
from pydrake.geometry import Meshcat, Rgba, Sphere

from drake_formation.viz import palette
from drake_formation.viz.packets import Packets, packets_of, thinned
from drake_formation.viz.playback import Playback
from drake_formation.viz.view.solids import TALKING_HEIGHT, Colour, opaque

MOST, AT_ONCE = 3000, 120
"""Packets that are drawn, and balls for them."""

FLYING: Colour = opaque(palette.FLYING)
LOST: Colour = opaque(palette.ALARM)
RADII = {False: 0.04, True: 0.055}
"""Of balls, and of those that are lost (m)."""

APART = 1 / 256
"""Between two packets of one ball, lest it be seen on its way from one to the next (s)."""


class Flights:
    """The packets of a run, no more of them than a browser bears.

    Args:
        meshcat: where.
        root: path of all balls.
        playback: of the run.

    Attributes:
        shown: those that are drawn.
    """

    def __init__(self, meshcat: Meshcat, root: str, playback: Playback) -> None:
        self._meshcat, self._root, self._playback = meshcat, root, playback
        self.shown = drawn_packets(playback)
        self._balls = {lost: _balls(self.shown.some(self.shown.lost == lost)) for lost in (False, True)}
        for lost, colour in ((False, FLYING), (True, LOST)):
            for ball in range(len(self._balls[lost])):
                meshcat.SetObject(self._path(lost, ball), Sphere(RADII[lost]), Rgba(*colour))

    def record(self) -> None:
        """Let every ball be seen while its packets are under way."""
        for lost, balls in self._balls.items():
            packets = self.shown.some(self.shown.lost == lost)
            begins, ends = (packets.places(self._playback, time) for time in (packets.start, packets.end))
            for ball, its in enumerate(balls):
                path = self._path(lost, ball)
                self._meshcat.SetProperty(path, "visible", False, 0.0)
                for k in its:
                    self._set(path, packets.start[k], begins[k].tolist(), seen=True)
                    self._set(path, packets.end[k], ends[k].tolist(), seen=False)

    def _set(self, path: str, time: float, place: list[float], *, seen: bool) -> None:
        moment = max(float(time) - self._playback.begin, 0.0)
        self._meshcat.SetProperty(path, "position", [*place, TALKING_HEIGHT], moment)
        self._meshcat.SetProperty(path, "visible", seen, moment)

    def _path(self, lost: bool, ball: int) -> str:
        return f"{self._root}/{'lost' if lost else 'flying'}/{ball + 1}"


def drawn_packets(playback: Playback) -> Packets:
    """Those packets of a run that are drawn."""
    packets = packets_of(playback)
    return thinned(packets.some(packets.end <= playback.end), MOST, AT_ONCE)


def _balls(packets: Packets) -> list[list[int]]:
    """Which packets each ball is, one after the other, with as few balls as may be."""
    balls: list[list[int]] = []
    free: list[tuple[float, int]] = []
    for k in np.argsort(packets.start, kind="stable").tolist():
        if free and free[0][0] + APART <= packets.start[k]:
            _, ball = heapq.heappop(free)
        else:
            ball = len(balls)
            balls.append([])
        balls[ball].append(k)
        heapq.heappush(free, (float(packets.end[k]), ball))
    return balls
