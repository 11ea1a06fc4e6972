"""Sensors of position and velocity that are sampled, noisy, biased, and sometimes silent."""

from collections.abc import Hashable, Iterator
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import Period, Point, Probability, Section, Velocity
from drake_formation.formation.formation import Formation
from drake_formation.formation.names import robot_name
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.systems.random_stream import next_normal, next_uniform, random_start
from drake_formation.systems.scalars import Scalar, at_most
from drake_formation.systems.templates import block_template, in_double

Deviation = Annotated[float, Field(ge=0, le=1e6)]
"""A standard deviation, bounded as coordinates are."""

STREAMS = ("x", "y", "x_rate", "y_rate", "dropout")
"""Streams of random numbers of a sensor; each has two numbers of state."""


def measured_state(
    state: list[Scalar], before: list[Scalar], generators: list[Scalar], noise: list[Scalar], bias: list[Scalar]
) -> tuple[list[Scalar], list[Scalar]]:
    """What a sensor shows of a state, x + b + σ n, or as before where the sample is lost; and its generators' states.

    Args:
        state: x, as it is (m, m/s), four numbers.
        before: what it showed until now.
        generators: states of the ``STREAMS``, ten numbers.
        noise: standard deviations of position (m) and velocity (m/s), and the probability of a loss.
        bias: b (m, m/s), four numbers.
    """
    position, velocity, loss = noise
    drawn, after = [], []
    for k in range(4):
        normal, own = next_normal(generators[2 * k : 2 * k + 2])
        drawn.append(normal)
        after += own
    chance, *own = next_uniform(*generators[8:])
    lost = at_most(chance, loss)
    deviations = (position, position, velocity, velocity)
    seen = [x + b + s * n for x, b, s, n in zip(state, bias, deviations, drawn, strict=True)]
    return [(1.0 - lost) * new + lost * old for new, old in zip(seen, before, strict=True)], [*after, *own]


@block_template("NoisySensor_", __name__)
def NoisySensor_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The sensor as a template over double, AutoDiffXd and Expression; see :class:`NoisySensor`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """What a robot sees of its state at the times 0, T, 2T, …, held in between.

        Input port: ``true_state`` (m, m/s, size 4). Output port: ``measured`` (size 4), discrete state 0. Discrete
        state 1: its random streams' states (size 10). Parameters: 0, standard deviations of position (m) and velocity
        (m/s), and the probability of a loss; 1, bias (m, m/s, four numbers).
        """

        def _construct(
            self, period: float, noise: ArrayLike, bias: ArrayLike, start: ArrayLike, streams: ArrayLike,
            *, converter: Any = None,
        ) -> None:  # fmt: skip
            """Make the sensor.

            Args:
                period: T (s).
                noise: σ of position (m), σ of velocity (m/s), and probability of a loss, shape (3,).
                bias: (m, m/s), shape (4,).
                start: what it shows before the first sample (m, m/s), shape (4,).
                streams: where its random streams start, shape (10,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (period, noise, bias, start, streams)
            self.kind = period  # all else that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("true_state", 4)
            for group in (noise, bias):
                self.DeclareNumericParameter(BasicVector_[T](group))
            shown_state = self.DeclareDiscreteState(BasicVector_[T](start))
            self.DeclareDiscreteState(BasicVector_[T](streams))
            self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._sample)
            self.DeclareStateOutputPort("measured", shown_state)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _sample(self, context: Any, memory: Any) -> None:
            before, generators = (context.get_discrete_state(k).CopyToVector().tolist() for k in (0, 1))
            noise, bias = (context.get_numeric_parameter(k).CopyToVector().tolist() for k in (0, 1))
            seen, after = measured_state(self._state.Eval(context).tolist(), before, generators, noise, bias)
            memory.set_value(0, np.array(seen))
            memory.set_value(1, np.array(after))

    return Impl


NoisySensor = in_double(NoisySensor_)


@block_template("BiasedSensor_", __name__)
def BiasedSensor_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The sensor as a template over double, AutoDiffXd and Expression; see :class:`BiasedSensor`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """What a robot sees of its state, at once and off by a bias.

        Input port: ``true_state`` (m, m/s, size 4). Output port: ``measured`` (size 4). Parameter: 0, bias (m, m/s).
        """

        def _construct(self, bias: ArrayLike, *, converter: Any = None) -> None:
            """Make the sensor.

            Args:
                bias: (m, m/s), shape (4,).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (bias,)
            self.kind = "biased"  # all that it computes with is a parameter
            self._state = self.DeclareVectorInputPort("true_state", 4)
            self.DeclareNumericParameter(BasicVector_[T](bias))
            read = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
            self.DeclareVectorOutputPort("measured", 4, self._calc_measured, read)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_measured(self, context: Any, output: Any) -> None:
            bias = context.get_numeric_parameter(0).CopyToVector().tolist()
            state = self._state.Eval(context).tolist()
            output.SetFromVector(np.array([x + b for x, b in zip(state, bias, strict=True)]))

    return Impl


BiasedSensor = in_double(BiasedSensor_)


@part("sensor", kind="noisy")
class NoisyStateSensor(Part):
    """Position and velocity sampled with noise, bias and dropouts, and held in between."""

    class Config(Section):
        """What it lacks in perfection."""

        period: Period | None = Field(
            default=0.01, description="sampling period T (s), counted from time 0; null: continuously; chosen: 0.01"
        )
        position_noise: Deviation = Field(
            default=0.0, description="standard deviation of either coordinate of the position (m); chosen: 0"
        )
        velocity_noise: Deviation = Field(
            default=0.0, description="standard deviation of either component of the velocity (m/s); chosen: 0"
        )
        position_bias: Point = Field(default=(0.0, 0.0), description="added to the position (m); chosen: none")
        velocity_bias: Velocity = Field(default=(0.0, 0.0), description="added to the velocity (m/s); chosen: none")
        dropout: Probability = Field(
            default=0.0, description="probability that a sample is lost, and the one before it kept (1); chosen: 0"
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether there are samples to draw random numbers for."""
        if self.config.period is not None:
            return
        for name in ("position_noise", "velocity_noise", "dropout"):
            if value := getattr(self.config, name):
                message = "drawn anew for every sample, and without a period there is none"
                yield Fault((name,), message, shown(value), "0, or also a period (s)")

    def structure(self) -> Hashable:
        """The period, which a block is made with."""
        period: float | None = self.config.period
        return period

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """Noise and loss, where it is sampled, and bias."""
        config = self.config
        bias = np.array([*config.position_bias, *config.velocity_bias])
        if config.period is None:
            return (bias,)
        return np.array([config.position_noise, config.velocity_noise, config.dropout]), bias

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:
        """The sensor."""
        if self.config.period is None:
            return BiasedSensor(*numbers)
        return NoisySensor(self.config.period, *numbers, *self._start(formation, owner))

    def initial_discrete_state(self, formation: Formation, owner: int) -> Numbers | None:
        """The state at the start, as it is, and where the random streams start."""
        return None if self.config.period is None else self._start(formation, owner)

    def _start(self, formation: Formation, owner: int) -> Numbers:
        return formation.start_state(owner), random_starts(formation, owner, STREAMS)


def random_starts(formation: Formation, robot: int, streams: tuple[str, ...]) -> Any:
    """Where the random streams of a robot's sensor start, shape (2 streams,)."""
    places = [f"{robot_name(robot)}/sensor/{name}" for name in streams]
    return np.concatenate([random_start(formation.seed, place) for place in places])
