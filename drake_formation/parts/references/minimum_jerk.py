"""The minimum-jerk course: from rest to rest with the least jerk (Flash and Hogan 1985)."""

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydrake.polynomial import Polynomial
from pydrake.trajectories import PiecewisePolynomial

from drake_formation.formation.formation import Formation
from drake_formation.parts.references.trajectory import Motion
from drake_formation.parts.registry import part

Array = NDArray[np.float64]

SHARE = (0.0, 0.0, 0.0, 10.0, -15.0, 6.0)
"""Share of the way covered after the share u of the time: 10 u³ − 15 u⁴ + 6 u⁵; coefficients of u⁰ to u⁵."""

HALVINGS = 60
"""Of an interval of 1, after which it is shorter than rounding."""


def minimum_jerk(start: ArrayLike, goal: ArrayLike, duration: float) -> PiecewisePolynomial:
    """A straight line from rest to rest with the least jerk: velocity and acceleration are zero at both ends.

    Args:
        start: where it begins (m), shape (2,).
        goal: where it ends (m), shape (2,).
        duration: how long it takes (s).

    Returns:
        Position (m, shape (2, 1)) over the time since the start (s). Its peak speed is 1.875 distance/duration.
    """
    begin, way = np.asarray(start, dtype=float), np.subtract(goal, start)
    course = np.array(SHARE) / duration ** np.arange(len(SHARE))
    lines = [np.array([x, 0.0, 0.0, 0.0, 0.0, 0.0]) + dx * course for x, dx in zip(begin, way, strict=True)]
    return PiecewisePolynomial([np.array([[Polynomial(line)] for line in lines])], [0.0, duration])


def time_share(share: ArrayLike) -> Array:
    """Share of the time after which a minimum-jerk course has covered a share of the way; both from 0 to 1."""
    given = np.asarray(share, dtype=float)
    # The course is symmetric; only its first half tells shares of the way apart to the last digit.
    wanted = np.minimum(given, 1.0 - given)
    covered = np.polynomial.Polynomial(SHARE)
    # It never falls, so halving finds it; Newton's rule fails where it is flat, SciPy's betaincinv(3, 3, share) too.
    early, late = np.zeros_like(wanted), np.full_like(wanted, 0.5)
    for _ in range(HALVINGS):
        middle = (early + late) / 2
        enough = covered(middle) >= wanted
        early, late = np.where(enough, early, middle), np.where(enough, middle, late)
    passed = np.where(wanted > 0.0, late, 0.0)
    return np.where(given > 0.5, 1.0 - passed, passed)


@part("reference", kind="minimum_jerk")
class MinimumJerk(Motion):
    """A straight line to the goal with the least jerk."""

    def trajectory(self, formation: Formation) -> PiecewisePolynomial:
        """From where the formation gathers to the goal."""
        return minimum_jerk(formation.centre, formation.goal, self.duration(formation))
