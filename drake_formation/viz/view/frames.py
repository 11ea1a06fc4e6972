"""At which times a recording needs its pictures, where a browser draws straight lines between them."""

import heapq
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from drake_formation.viz.links import Link, alive, lengths, present
from drake_formation.viz.playback import Playback

Array = NDArray[np.float64]

RATE = 64.0
"""Pictures a second at the most; a power of two, so that every time is exact."""

REGULAR = 2.0
"""Pictures a second at the least."""

TOLERANCE = 2e-3
"""How far anything may be off between two pictures (m)."""

ARM = 0.3
"""By which a heading counts as a distance (m)."""

CHANGE = 0.02
"""By which it counts as a distance that a link is gone, or falls silent (m)."""


def key_times(playback: Playback, links: Sequence[Link], most: int) -> Array:
    """Times of the pictures, counted from the begin of the result (s), first and last included.

    There are some every second, and between them as many as the tolerance asks for. Where those would be too many, as
    while stiff springs ring, the largest excursions are shown, and small ones between them are not.

    Args:
        playback: what is to be recorded.
        links: what is stretched, each by its length.
        most: how many pictures there may be, if those of every second leave room for any.
    """
    count = int(np.ceil((playback.end - playback.begin) * RATE))
    if not count:
        return np.zeros(1)
    times = np.minimum(np.arange(count + 1) / RATE, playback.end - playback.begin)
    moments = playback.begin + times
    points = playback.points(moments)
    places, turns = points.reshape(len(times), -1), ARM * playback.headings(moments)
    changes = CHANGE * np.column_stack([told(playback, links, moments) for told in (present, alive)])
    obstacles = playback.moved(moments).reshape(len(times), -1)
    course = np.column_stack([places, turns, lengths(links, points), changes, obstacles])
    given = sorted({*range(0, count, int(RATE / REGULAR)), count})
    return np.arange(count + 1)[corners(times, course, given, TOLERANCE, most)] / RATE


def corners(times: Array, course: Array, given: Sequence[int], tolerance: float, most: int) -> NDArray[np.intp]:
    """Samples between which straight lines stay within a tolerance of all others (Douglas & Peucker 1973).

    Args:
        times: rising, shape (samples,).
        course: what moves, shape (samples, columns).
        given: indices of samples that are among them, rising, the first and the last included.
        tolerance: in the units of the course.
        most: how many there may be; beyond that those count that are furthest off.

    Returns:
        Their indices, rising.
    """

    def span(first: int, last: int) -> tuple[float, int, int, int]:
        """Where a straight line between two samples is furthest off, and how far: negative, to be first in a heap."""
        share = ((times[first:last] - times[first]) / (times[last] - times[first]))[:, None]
        off = np.abs(course[first:last] - course[first] - share * (course[last] - course[first])).max(axis=1)
        worst = int(off.argmax())
        return -float(off[worst]), first, first + worst, last

    kept = list(given)
    spans = [span(first, last) for first, last in pairwise(given)]
    heapq.heapify(spans)
    while -spans[0][0] > tolerance and len(kept) < most:
        _, first, worst, last = heapq.heappop(spans)
        kept.append(worst)
        heapq.heappush(spans, span(first, worst))
        heapq.heappush(spans, span(worst, last))
    return np.array(sorted(kept))
