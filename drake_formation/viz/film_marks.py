"""What happens in a film: marks where events were, from then on, and crosses over robots that are out of order."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from numpy.typing import NDArray

from drake_formation.simulation.events import HAND_OFF
from drake_formation.viz.palette import ALARM
from drake_formation.viz.playback import Playback

Array = NDArray[np.float64]


class FilmMarks:
    """Marks and crosses.

    Args:
        axes: where.
        playback: of the run.
        times: of the pictures (s), shape (pictures,).
    """

    def __init__(self, axes: Axes, playback: Playback, times: Array) -> None:
        self._times, self._failed = times, playback.failed(times)
        self._events = playback.events
        happened = [event for event in playback.events if event.kind != HAND_OFF]
        self._when = np.array([event.time for event in happened])
        self._where = np.array([event.place for event in happened]).reshape(-1, 2)
        (self._marks,) = axes.plot([], [], "v", color=ALARM, markersize=6, markeredgecolor="white", zorder=5)
        (self._crosses,) = axes.plot([], [], "x", color=ALARM, markersize=11, markeredgewidth=2.2, zorder=6)

    def show(self, number: int, points: Array) -> list[Artist]:
        """Draw a picture.

        Args:
            number: which, from 0.
            points: where the robots are (m), shape (N or more, 2).
        """
        self._marks.set_data(*self._where[self._when <= self._times[number]].T)
        self._crosses.set_data(*points[np.flatnonzero(self._failed[number])].T)
        return [self._marks, self._crosses]

    def told(self, number: int) -> str:
        """What happened last before a picture, or nothing."""
        told = [f"{event.time:.4g} s: {event.sentence}" for event in self._events if event.time <= self._times[number]]
        return told[-1] if told else ""
