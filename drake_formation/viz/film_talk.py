"""Who hears whom in a film: channels, packets on their way at the moment of each picture, and lost ones."""

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from numpy.typing import NDArray

from drake_formation.vectors import turned_left
from drake_formation.viz.links import alive, channel_links
from drake_formation.viz.packets import packets_of
from drake_formation.viz.palette import ALARM, CHANNEL, FLYING, SILENT
from drake_formation.viz.playback import Playback

Array = NDArray[np.float64]

ASIDE = 0.04
"""How far a channel is drawn to the left of the straight line from who speaks to who hears, as a share of it (1)."""

PACKET, SIZES = 0.05, (1.2, 4.0)
"""Size of a packet (m), and between which sizes it is drawn (1/72 in)."""


class FilmTalk:
    """Channels as thin lines, dotted and grey where they are silent; packets as dots, lost ones as crosses.

    Args:
        axes: where.
        playback: of the run.
        times: of the pictures (s), shape (pictures,).
        scale: points (1/72 in) a metre.
    """

    def __init__(self, axes: Axes, playback: Playback, times: Array, scale: float) -> None:
        self._playback, self._times = playback, times
        links = channel_links(playback.formation)
        self._alive = alive(playback, links, times)
        self._ends = np.array([[link.start, link.end] for link in links], dtype=np.intp).reshape(-1, 2)
        self._packets = packets_of(playback)
        self._lines = LineCollection([], linewidths=0.7, zorder=1.5)
        axes.add_collection(self._lines)
        size = float(np.clip(PACKET * scale, *SIZES))
        (self._flying,) = axes.plot([], [], "o", color=FLYING, markersize=size, markeredgewidth=0, zorder=4)
        (self._lost,) = axes.plot([], [], "x", color=ALARM, markersize=2 * size, markeredgewidth=size / 2, zorder=4)

    def show(self, number: int, points: Array) -> list[Artist]:
        """Draw a picture.

        Args:
            number: which, from 0.
            points: where the robots are (m), shape (N or more, 2).
        """
        lines = points[self._ends]
        aside = ASIDE * turned_left(lines[:, 1] - lines[:, 0])
        alive = self._alive[number]
        self._lines.set_segments(list(lines + aside[:, None]))
        self._lines.set_color([CHANNEL if hears else SILENT for hears in alive] or "none")
        self._lines.set_linestyle(["-" if hears else ":" for hears in alive] or "solid")
        time = float(self._times[number])
        seen = self._packets.some(self._packets.under_way(time))
        places = seen.places(self._playback, np.full(len(seen), time)) + aside[seen.channel]
        self._flying.set_data(*places[~seen.lost].T)
        self._lost.set_data(*places[seen.lost].T)
        return [self._lines, self._flying, self._lost]
