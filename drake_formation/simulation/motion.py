"""A run between its samples: the quintics that have position, velocity and acceleration at both ends of a step.

An integrator's steps are up to ``simulator.max_step_size`` long, and what happens within them is as much part of the
run as the samples are. Quintic Hermite interpolation is of the sixth order in the step, one more than the integrators
are (Hairer, Nørsett & Wanner, Sec. II.6).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from drake_formation.parts.references.trajectory import polynomial_motion

Array = NDArray[np.float64]
Indices = NDArray[np.intp]

ROUNDING = 16 * np.finfo(float).eps
"""Share of a position below which a difference of positions is rounding."""


@dataclass(frozen=True)
class Motion:
    """Points that move in the plane.

    Attributes:
        times: sample times (s), rising, shape (samples,).
        position: (m), shape (samples, points, 2).
        velocity: (m/s), of the same shape.
        acceleration: (m/s²), of the same shape; where it jumps, the value from there on, unless ``leaving`` is given.
        leaving: acceleration with which every step begins (m/s²), shape (samples − 1, points, 2), where it jumps at
            samples that show the value until then.
    """

    times: Array
    position: Array
    velocity: Array
    acceleration: Array
    leaving: Array | None = None

    def at(self, step: Indices, share: Array) -> tuple[Array, Array, Array]:
        """Position, velocity and acceleration of all points within steps.

        Args:
            step: index of the sample before, shape (m,).
            share: how much of the step has passed, from 0 to 1; shape (m, k).

        Returns:
            Three arrays of shape (m, k, points, 2).
        """
        coefficients = [x[:, None] for x in self._coefficients(step)]
        position, slope, curvature = polynomial_motion(share[..., None, None], coefficients)
        length = np.diff(self.times)[step][:, None, None, None]
        return position, slope / length, curvature / length**2

    def at_times(self, times: Array) -> tuple[Array, Array, Array]:
        """The same at times between the first sample and the last (s), shape (m,); each of shape (m, points, 2)."""
        if len(self.times) == 1:
            first = np.zeros(len(times), dtype=np.intp)
            return self.position[first], self.velocity[first], self.acceleration[first]
        step = np.clip(np.searchsorted(self.times, times, "right") - 1, 0, len(self.times) - 2)
        share = (times - self.times[step]) / np.diff(self.times)[step]
        position, velocity, acceleration = self.at(step, share[:, None])
        return position[:, 0], velocity[:, 0], acceleration[:, 0]

    def with_samples_at(self, times: Array) -> "Motion":
        """The same motion with samples at further times too, as far as it goes on then (s)."""
        inside = times[(times > self.times[0]) & (times < self.times[-1])]
        more = np.setdiff1d(inside, self.times)
        if not len(more):
            return self
        order = np.argsort(np.concatenate([self.times, more]), kind="stable")
        own = (self.position, self.velocity, self.acceleration)
        joined = [np.concatenate(pair)[order] for pair in zip(own, self.at_times(more), strict=True)]
        return Motion(np.concatenate([self.times, more])[order], *joined)

    def bulge(self) -> Array:
        """How far each point leaves the chord of each step at the most (m), shape (samples − 1, points).

        A second derivative stays within the hull of its Bézier points; a curve whose second derivative over a unit of
        time is nowhere longer than b leaves its chord by b/8 at the most.
        """
        _, _, c2, c3, c4, c5 = self._coefficients(slice(None, len(self.times) - 1))
        middle = c2 + c3
        corners = (c2, middle, middle + c3 + 2 * c4, middle + 2 * c3 + 6 * c4 + 10 * c5)
        squared = np.maximum.reduce([x[..., 0] ** 2 + x[..., 1] ** 2 for x in corners])
        result: Array = 0.25 * np.sqrt(squared)
        return result

    def _coefficients(self, step: Indices | slice) -> tuple[Array, ...]:
        """Of the quintics over the share of a step, in rising powers (m), each of shape (m, points, 2)."""
        after = slice(1, None) if isinstance(step, slice) else step + 1
        length = np.diff(self.times)[step][:, None, None]
        position, leaving = self.position[step], self.acceleration if self.leaving is None else self.leaving
        slope, curvature = length * self.velocity[step], length**2 * leaving[step]
        # What the parabola that leaves as the quintic does lacks at the end; what rounding leaves of it is no motion,
        # though over a step of a picosecond it would be a great speed.
        way = self.position[after] - position - slope - 0.5 * curvature
        way = np.where(np.abs(way) > ROUNDING * np.abs(position), way, 0.0)
        turn = length * self.velocity[after] - slope - curvature
        bend = 0.5 * (length**2 * self.acceleration[after] - curvature)
        return (
            position,
            slope,
            0.5 * curvature,
            10 * way - 4 * turn + bend,
            -15 * way + 7 * turn - 2 * bend,
            6 * way - 3 * turn + bend,
        )
