"""A sensor of position, and a Kalman filter that tells the velocity from it (Bar-Shalom, Li & Kirubarajan 2001)."""

import functools
import math
from collections.abc import Hashable, Iterator
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.estimators import DiscreteTimeSteadyStateKalmanFilter
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import Period, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.parts.sensors.noisy import random_starts
from drake_formation.systems.random_stream import next_normal
from drake_formation.systems.scalars import Scalar
from drake_formation.systems.templates import block_template, in_double

Noise = Annotated[float, Field(ge=1e-6, le=1e6)]
"""A standard deviation above 0: without noise there is no gain to design."""

STREAMS = ("x", "y")


@functools.lru_cache(maxsize=1024)
def steady_gain(period: float, position_noise: float, acceleration_noise: float) -> tuple[float, float]:
    """Gain K of the filter in the steady state, from Drake's ``DiscreteTimeSteadyStateKalmanFilter``.

    One axis is a double integrator whose unknown acceleration is white from sample to sample (Sec. 6.3.2). With the
    period as unit of time and σ_a T² as unit of length, only the noise of the measurement depends on the numbers, by
    the tracking index σ_a T²/σ_q. Drake's gain L = A K corrects what is predicted for the next sample; K corrects what
    is known at this one.

    Args:
        period: T (s).
        position_noise: σ_q (m).
        acceleration_noise: σ_a (m/s²).

    Returns:
        What a metre that the position is off adds to position (1) and velocity (1/s); not a number where Drake finds
        none.
    """
    a, c, push = np.array([[1.0, 1.0], [0.0, 1.0]]), np.array([[1.0, 0.0]]), np.array([0.5, 1.0])
    noise = position_noise / (acceleration_noise * period**2)
    try:
        observer = DiscreteTimeSteadyStateKalmanFilter(a, c, np.outer(push, push), np.array([[noise**2]]))
    except (RuntimeError, SystemExit):  # SystemExit is how Drake reports a failed demand
        return math.nan, math.nan
    position, velocity = np.linalg.solve(a, observer).ravel().tolist()
    return position, velocity / period


def predicted(estimate: list[Scalar], force: list[Scalar], mass: Scalar, elapsed: Scalar) -> list[Scalar]:
    """Where a robot is after a time under a force that is held.

    Args:
        estimate: position and velocity (m, m/s), four numbers.
        force: asked of its actuators (N).
        mass: m (kg).
        elapsed: the time (s).
    """
    (x, y, vx, vy), (ax, ay) = estimate, (f / mass for f in force)
    half = 0.5 * elapsed * elapsed
    return [x + elapsed * vx + half * ax, y + elapsed * vy + half * ay, vx + elapsed * ax, vy + elapsed * ay]


def corrected(estimate: list[Scalar], position: list[Scalar], gain: list[Scalar]) -> list[Scalar]:
    """An estimate after a position is measured: x̂ + K (y − q̂).

    Args:
        estimate: position and velocity (m, m/s), four numbers.
        position: measured (m).
        gain: K, two numbers (1, 1/s).
    """
    (x, y, vx, vy), (k, kv) = estimate, gain
    off_x, off_y = position[0] - x, position[1] - y
    return [x + k * off_x, y + k * off_y, vx + kv * off_x, vy + kv * off_y]


def next_covariance(
    covariance: list[Scalar], elapsed: Scalar, position_noise: Scalar, acceleration_noise: Scalar
) -> tuple[list[Scalar], list[Scalar]]:
    """The gain at a sample, and the covariance after it, of either axis (Sec. 5.2.4).

    Args:
        covariance: P of position and velocity after the sample before: P_qq (m²), P_qv (m²/s), P_vv (m²/s²).
        elapsed: time since then (s).
        position_noise: σ_q (m).
        acceleration_noise: σ_a (m/s²).
    """
    qq, qv, vv = covariance
    push = 0.5 * elapsed * elapsed * acceleration_noise, elapsed * acceleration_noise
    qq = qq + elapsed * (2.0 * qv + elapsed * vv) + push[0] * push[0]
    qv = qv + elapsed * vv + push[0] * push[1]
    vv = vv + push[1] * push[1]
    innovation = qq + position_noise * position_noise
    k, kv = qq / innovation, qv / innovation
    return [k, kv], [(1.0 - k) * qq, (1.0 - k) * qv, vv - kv * qv]


@block_template("KalmanSensor_", __name__)
def KalmanSensor_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The sensor and its filter as a template over double, AutoDiffXd and Expression; see :class:`KalmanSensor`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A robot's position and velocity from its position alone, measured at the times 0, T, 2T, … and held.

        Input ports: ``true_state`` (m, m/s, size 4) and ``demanded``, the force asked of its actuators (N, size 2).
        Output port: ``measured`` (size 4), the estimate, discrete state 0. Discrete state 1: the time of the estimate
        (s), and of a filter that is not steady its covariance (three numbers); 2: the random streams' states (size 4).
        Parameters: 0, σ of the position (m), mass (kg), and the steady gain (1, 1/s) or σ of the acceleration (m/s²).
        """

        def _construct(
            self, period: float, steady: bool, numbers: ArrayLike, start: ArrayLike, memory: ArrayLike,
            streams: ArrayLike, *, converter: Any = None,
        ) -> None:  # fmt: skip
            """Make the sensor.

            Args:
                period: T (s).
                steady: whether the gain is the steady one.
                numbers: parameter 0.
                start: the estimate at the start (m, m/s), shape (4,).
                memory: discrete state 1 at the start.
                streams: where its random streams start, shape (4,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (period, steady, numbers, start, memory, streams)
            self.kind = period, steady  # all else that it computes with is a parameter
            self._steady = steady
            self._state = self.DeclareVectorInputPort("true_state", 4)
            self._force = self.DeclareVectorInputPort("demanded", 2)
            self.DeclareNumericParameter(BasicVector_[T](numbers))
            estimate, *_ = [self.DeclareDiscreteState(BasicVector_[T](group)) for group in (start, memory, streams)]
            self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._sample)
            self.DeclareStateOutputPort("measured", estimate)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _sample(self, context: Any, memory: Any) -> None:
            estimate, (since, *covariance), streams = (
                context.get_discrete_state(k).CopyToVector().tolist() for k in range(3)
            )
            deviation, mass, *gain = context.get_numeric_parameter(0).CopyToVector().tolist()
            elapsed = context.get_time() - since
            if not self._steady:
                gain, covariance = next_covariance(covariance, elapsed, deviation, *gain)
            (off_x, first), (off_y, second) = next_normal(streams[:2]), next_normal(streams[2:])
            x, y, _, _ = self._state.Eval(context).tolist()
            # Before this moment's updates the port still shows the force of the time that went by.
            estimate = predicted(estimate, self._force.Eval(context).tolist(), mass, elapsed)
            estimate = corrected(estimate, [x + deviation * off_x, y + deviation * off_y], gain)
            memory.set_value(0, np.array(estimate))
            memory.set_value(1, np.array([context.get_time(), *covariance]))
            memory.set_value(2, np.array([*first, *second]))

    return Impl


KalmanSensor = in_double(KalmanSensor_)


@part("sensor", kind="kalman")
class KalmanFilter(Part):
    """Position sampled with noise, and velocity from a Kalman filter that knows the force asked and the mass."""

    class Config(Section):
        """What is measured how well, and what the filter takes to be unknown."""

        period: Period = Field(default=0.01, description="sampling period T (s), counted from time 0; chosen: 0.01")
        position_noise: Noise = Field(
            default=0.01, description="standard deviation σ_q of either coordinate of the position (m); chosen: 0.01"
        )
        acceleration_noise: Noise = Field(
            default=0.1,
            description="standard deviation σ_a of what the filter takes to be unknown of either acceleration (m/s²), "
            "as what the object exerts; chosen: 0.1",
        )
        gain: Literal["steady", "time_varying"] = Field(
            default="steady",
            description="steady: in the steady state; time_varying: by the covariance, from a start that is known",
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether Drake finds a gain."""
        if not np.isfinite(self._numbers).all():
            noise = self.config.position_noise
            allowed = "noises and a period of less different sizes"
            yield Fault(("position_noise",), "Drake finds no steady gain", shown(noise), allowed)

    @property
    def _numbers(self) -> list[float]:
        """The gain, or what it follows from."""
        config = self.config
        noises = config.position_noise, config.acceleration_noise
        return list(steady_gain(config.period, *noises)) if self._steady else [config.acceleration_noise]

    @property
    def _steady(self) -> bool:
        return bool(self.config.gain == "steady")

    def structure(self) -> Hashable:
        """Period and kind of gain, which a block is made with."""
        return self.config.period, self.config.gain

    def numbers(self, formation: Formation, owner: int) -> Numbers:
        """σ of the position, the mass, and the steady gain or σ of the acceleration."""
        return (np.array([self.config.position_noise, formation.masses[owner], *self._numbers]),)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The sensor and its filter."""
        start = self.initial_discrete_state(formation, owner)
        return KalmanSensor(self.config.period, self._steady, *numbers, *start)

    def initial_discrete_state(self, formation: Formation, owner: int) -> Numbers:
        """The state at the start, as it is; since when, and that it is known; and where the random streams start."""
        memory = np.array([formation.begin, *([] if self._steady else np.zeros(3))])
        return formation.start_state(owner), memory, random_starts(formation, owner, STREAMS)
