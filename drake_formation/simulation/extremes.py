"""The longest and the shortest that vectors become between samples too.

Most steps are discarded at once: what they may reach, by their ends and how far they bulge from their chord, falls
short of what is reached elsewhere. The rest are cut finer and finer where they come nearest to the extreme.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.simulation.motion import Motion
from drake_formation.vectors import from_segment, least_from_segment, least_length, length_of

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Law = Callable[[Array, Array, Array], Array]
Score = Callable[[Array, Array | None], Array]
ChordScore = Callable[[Array, Array, Array | None], Array]

CUTS, FEW_CUTS = 32, 4
"""Parts into which a stretch is cut; few at first, which discard most stretches."""
ROUNDS = 6
"""How often at most; by then a part is a millionth of its step or less."""
FINE = 1e-6
"""A part of a step no longer than this is cut for the last time."""
NEGLIGIBLE = 1e-9
"""A step that may reach no further than this beyond what is known is discarded (m, N)."""


@dataclass(frozen=True)
class Vectors:
    """Vectors in the plane that follow from a motion.

    Attributes:
        motion: of some points.
        law: from times (s), of any shape, positions (m) and velocities (m/s), of that shape and (points, 2), to
            vectors of that shape and (vectors, 2).
        samples: the vectors at the motion's samples, shape (samples, vectors, 2).
        bulge: how far each leaves the chord of each step at the most, shape (samples − 1, vectors).
        extents: where the least length is asked for, of what distance: from segments from the origin to these, shape
            (vectors, 2), or from the origin itself.
    """

    motion: Motion
    law: Law
    samples: Array
    bulge: Array
    extents: Array | None = None

    @classmethod
    def of_positions(cls, motion: Motion, bulge: Array, law: Callable[[Array], Array] = lambda x: x) -> "Vectors":
        """Vectors that follow from positions alone.

        Args:
            motion: of some points.
            bulge: how far each vector leaves the chord of each step at the most, shape (samples − 1, vectors).
            law: from positions (m), shape (..., points, 2), to vectors, shape (..., vectors, 2).
        """
        return cls(motion, lambda _times, position, _velocity: law(position), law(motion.position), bulge)

    def within(self, step: Indices, share: Array) -> Array:
        """Their values within some steps.

        Args:
            step: index of the sample before, shape (m,).
            share: how much of the step has passed, from 0 to 1; shape (m, k).

        Returns:
            Shape (m, k, vectors, 2).
        """
        times = self.motion.times[step, None] + share * np.diff(self.motion.times)[step, None]
        position, velocity, _ = self.motion.at(step, share)
        values: Array = self.law(times, position, velocity)
        return values


def longest(vectors: Vectors, *, each: bool = False) -> Array:
    """The greatest length of any vector at any time, shape (1,); or of each, shape (vectors,)."""
    return _extreme(vectors, _length, _chord_length, np.zeros(vectors.samples.shape[1]), each)


def shortest(vectors: Vectors, radii: Array | float = 0.0, *, each: bool = False) -> Array:
    """The same of the least length, after something is taken from it, shape (vectors,)."""
    less = np.broadcast_to(radii, vectors.samples.shape[1:2])
    return -_extreme(vectors, _nearness, _chord_nearness, less, each)


def last_beyond(vectors: Vectors, bound: float) -> tuple[int, float] | None:
    """When any vector is longer than a bound for the last time.

    Returns:
        The step (index of the sample before it) and how much of it has passed; the last sample and 0 where one still
        is at the end; None where none ever is.
    """
    beyond = length_of(vectors.samples) > bound
    if beyond[-1].any():
        return len(beyond) - 1, 0.0
    steps = beyond.any(axis=1)
    first = int(np.flatnonzero(steps)[-1]) if steps.any() else 0
    # From there on all samples are within the bound, but some steps may still reach beyond it.
    reach = (
        np.maximum(length_of(vectors.samples[first:-1]), length_of(vectors.samples[first + 1 :]))
        + vectors.bulge[first:]
    )
    for step in np.flatnonzero((reach > bound).any(axis=1))[::-1] + first:
        share = _last_share_beyond(vectors, step, bound, 0.0, 1.0, vectors.bulge[step])
        if share is not None:
            return int(step), share
    return None


def _last_share_beyond(
    vectors: Vectors, step: np.intp, bound: float, low: float, high: float, bulge: Array
) -> float | None:
    """How much of a step has passed when any vector is longer than a bound for the last time, or None.

    Args:
        vectors: what to look at.
        step: index of the sample before.
        bound: the length.
        low: where to look from,
        high: and to, as shares of the step.
        bulge: how far each vector leaves the chord from there to there at the most, shape (vectors,).
    """
    share, bulge = np.linspace(low, high, CUTS + 1), bulge / CUTS**2
    lengths = length_of(vectors.within(np.array([step]), share[None])[0])
    longer = np.maximum(lengths[:-1], lengths[1:])
    for part in np.flatnonzero((longer + bulge > bound).any(axis=1))[::-1]:
        if high - low > FINE:
            found = _last_share_beyond(vectors, step, bound, share[part], share[part + 1], bulge)
            if found is not None:
                return found
        elif (longer[part] > bound).any():
            return float(share[part])
    return None


def _extreme(vectors: Vectors, score: Score, on_chord: ChordScore, more: Array, each: bool) -> Array:
    """The highest score of any vector or of each.

    Args:
        vectors: what to look at.
        score: of a vector, to which is added
        more: of shape (vectors,).
        on_chord: the highest score, without what is added, on a straight line from a vector to another.
        each: of each.
    """
    extents = vectors.extents
    best: Array = (score(vectors.samples, extents) + more).max(axis=0 if each else None, keepdims=not each).reshape(-1)
    reach = on_chord(vectors.samples[:-1], vectors.samples[1:], extents) + more + vectors.bulge
    step, vector = np.nonzero(reach > best + NEGLIGIBLE * (1 + abs(best)))
    low, high, bulge = np.zeros(len(step)), np.ones(len(step)), vectors.bulge[step, vector]
    for cuts in (FEW_CUTS, *[CUTS] * ROUNDS):
        if not len(step):
            break
        share = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, cuts + 1)
        row, place = np.arange(len(step)), vector * each
        values = _values(vectors, step, vector, share)
        own = None if extents is None else extents[vector, None]
        parts = on_chord(values[:, :-1], values[:, 1:], own) + more[vector, None]
        chosen, highest, rest = parts.argmax(axis=1), parts.max(axis=1), bulge / cuts**2
        known = np.maximum(score(values, own).max(axis=1) + more[vector], highest - rest)
        np.maximum.at(best, place, known)
        if cuts == CUTS:  # a few are too few to tell where in its step a vector is at its extreme
            low, high = share[row, np.maximum(chosen - 1, 0)], share[row, np.minimum(chosen + 2, cuts)]
            bulge = rest * 3**2
        kept = highest + rest > (best + NEGLIGIBLE * (1 + abs(best)))[place]
        step, vector, low, high, bulge = step[kept], vector[kept], low[kept], high[kept], bulge[kept]
    return best


def _values(vectors: Vectors, step: Indices, vector: Indices, share: Array) -> Array:
    """One vector a row within its step, shape (m, k, 2); a whole step that several rows share is looked at once."""
    if len(step) and (share == share[0]).all():
        looked_at, row = np.unique(step, return_inverse=True)
        return vectors.within(looked_at, share[: len(looked_at)])[row, :, vector]
    return vectors.within(step, share)[np.arange(len(step)), :, vector]


def _length(values: Array, _extent: Array | None) -> Array:
    return length_of(values)


def _chord_length(begin: Array, end: Array, _extent: Array | None) -> Array:
    return np.maximum(length_of(begin), length_of(end))


def _nearness(values: Array, extent: Array | None) -> Array:
    return -length_of(values if extent is None else from_segment(values, extent))


def _chord_nearness(begin: Array, end: Array, extent: Array | None) -> Array:
    way = end - begin
    return -(least_length(begin, way) if extent is None else least_from_segment(begin, way, extent))
