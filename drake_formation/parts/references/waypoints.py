"""A smooth curve through waypoints: the quintic spline of least jerk."""

from collections.abc import Iterator
from math import factorial

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field
from pydrake.math import BsplineBasis
from pydrake.polynomial import Polynomial
from pydrake.trajectories import BsplineTrajectory, PiecewisePolynomial

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import Point
from drake_formation.formation.formation import Formation
from drake_formation.parts.references.minimum_jerk import time_share
from drake_formation.parts.references.trajectory import Motion, MotionConfig
from drake_formation.parts.registry import part

Array = NDArray[np.float64]

NEAREST = 1e-6
"""Points nearer to each other than this share of the whole way are passed too fast for any curve."""

ORDER = 6
"""Of a quintic spline: its number of coefficients a piece."""


def waypoint_trajectory(points: ArrayLike, duration: float) -> PiecewisePolynomial:
    """The curve of least jerk through points, from rest to rest; four times continuously differentiable.

    A point is passed when a minimum-jerk course along the chords would pass it, so the curve is slow at both ends, and
    points on a straight line leave the minimum-jerk course as it is, however many they are.

    Args:
        points: the start, points on the way, the goal (m), shape (points, 2), each apart from the one before.
        duration: how long it takes (s).

    Returns:
        Position (m, shape (2, 1)) over the time since the start (s); one piece between each point and the next.
    """
    places = np.asarray(points, dtype=float)
    # Solved over shares of the time, where the equations are well scaled; only the finished pieces know seconds.
    passed = time_share(chord_shares(places))
    spline = _interpolating_spline(places, passed)
    scale = [factorial(k) * duration**k for k in range(ORDER)]
    pieces = []
    for begin in passed[:-1]:
        x, y = np.column_stack([spline.EvalDerivative(begin, k).ravel() / scale[k] for k in range(ORDER)])
        pieces.append(np.array([[Polynomial(x)], [Polynomial(y)]]))
    return PiecewisePolynomial(pieces, passed * duration)


def chord_shares(points: Array) -> Array:
    """Share of the length of a polygonal line at each of its points, from 0 to 1; shape (points,)."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    shares: Array = lengths / lengths[-1]
    return shares


def _interpolating_spline(points: Array, passed: Array) -> BsplineTrajectory:
    """The quintic spline that passes points at given shares of the time, and rests at both ends.

    With its knots at the points in between, it has as many control points as there are conditions: one a point, and
    four for velocity and acceleration at the ends.
    """
    ends = passed[[0, -1]]
    basis = BsplineBasis(ORDER, [*[ends[0]] * ORDER, *passed[1:-1], *[ends[1]] * ORDER])
    # A spline whose control points are the rows of the identity evaluates to the equations' coefficients.
    unit = BsplineTrajectory(basis, list(np.eye(basis.num_basis_functions())[:, :, None]))
    rows = [unit.value(share).ravel() for share in passed]
    rows += [unit.EvalDerivative(end, k).ravel() for end in ends for k in (1, 2)]
    control = np.linalg.solve(np.array(rows), np.vstack([points, np.zeros((4, 2))]))
    return BsplineTrajectory(basis, list(control[:, :, None]))


@part("reference", kind="waypoints")
class Waypoints(Motion):
    """A smooth curve through points, such as the paper's s-curve (Fig. 19)."""

    class Config(MotionConfig):
        """The points."""

        points: tuple[Point, ...] = Field(
            strict=False,
            min_length=1,
            description="where the formation centre passes between where it gathers and the goal (m)",
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether it is in time, and passes each place once."""
        yield from self.duration_faults(formation)
        places, points = self.places(formation), self.config.points
        steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
        nearest = NEAREST * steps.sum()
        names = ["where the formation gathers", *(f"point {k + 1}" for k in range(len(points))), "the goal"]
        for k in np.flatnonzero(steps <= nearest):
            # The fault stands at a point that the user wrote: the later of the two, or the last before the goal.
            entry = min(int(k), len(points) - 1)
            message = f"{names[k]} and {names[k + 1]} are one place"
            allowed = f"points more than {nearest:.3g} m apart"
            yield Fault(("points", entry), message, shown(points[entry]), allowed)

    def places(self, formation: Formation) -> Array:
        """Where the formation centre passes, start and goal included (m), shape (points + 2, 2)."""
        return np.vstack([formation.centre, self.config.points, formation.goal])

    def trajectory(self, formation: Formation) -> PiecewisePolynomial:
        """Through the points."""
        return waypoint_trajectory(self.places(formation), self.duration(formation))
