"""At which times a recording needs its pictures, where a browser draws straight lines between them."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from drake_formation.viz.links import Link, lengths
from drake_formation.viz.playback import Playback

Array = NDArray[np.float64]

RATE = 64.0
"""Pictures a second at the most; a power of two, so that every time is exact."""

TOLERANCE = 2e-3
"""How far anything may be off between two pictures (m)."""

ARM = 0.3
"""By which a heading counts as a distance (m)."""


def key_times(playback: Playback, links: Sequence[Link], most: int) -> Array:
    """Times of the pictures, counted from the begin of the result (s), first and last included.

    Where that would be too many, as while stiff springs ring, everything may be further off, by a factor of two as
    often as needed: the largest excursions are shown, and small ones between them are not.

    Args:
        playback: what is to be recorded.
        links: what is stretched, each by its length.
        most: how many pictures there may be.
    """
    count = max(int(np.ceil((playback.end - playback.begin) * RATE)), 1)
    times = np.minimum(np.arange(count + 1) / RATE, playback.end - playback.begin)
    moments = playback.begin + times
    points = playback.points(moments)
    places, turns = points.reshape(len(times), -1), ARM * playback.headings(moments)
    course = np.column_stack([places, turns, lengths(links, points)])
    tolerance = TOLERANCE
    while len(chosen := corners(times, course, tolerance)) > most:
        tolerance *= 2.0
    return np.arange(count + 1)[chosen] / RATE


def corners(times: Array, course: Array, tolerance: float) -> NDArray[np.intp]:
    """Samples between which straight lines stay within a tolerance of all others (Douglas & Peucker 1973).

    Args:
        times: rising, shape (samples,).
        course: what moves, shape (samples, columns).
        tolerance: in the units of the course.

    Returns:
        Their indices, rising; the first and the last are among them.
    """
    kept, open_spans = {0, len(times) - 1}, [(0, len(times) - 1)]
    while open_spans:
        first, last = open_spans.pop()
        if last - first < 2:
            continue
        share = ((times[first:last] - times[first]) / (times[last] - times[first]))[:, None]
        off = np.abs(course[first:last] - course[first] - share * (course[last] - course[first])).max(axis=1)
        worst = int(off.argmax())
        if off[worst] > tolerance:
            kept.add(first + worst)
            open_spans += [(first, first + worst), (first + worst, last)]
    return np.array(sorted(kept))
