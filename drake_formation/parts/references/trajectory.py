"""A trajectory as reference: any piecewise polynomial, played from the hand-off on."""

from collections.abc import Iterator
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_
from pydrake.trajectories import PiecewisePolynomial

from drake_formation.config.errors import Fault, Path, shown
from drake_formation.config.values import Positive, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.systems.scalars import Scalar, row_at
from drake_formation.systems.templates import block_template, in_double

Array = NDArray[np.float64]

SHORTEST, LONGEST = 1e-3, 1e6
"""Durations of a motion (s) between which the coefficients of its polynomials neither overflow nor vanish."""

COEFFICIENTS = 6
"""Coefficients of a coordinate in a piece: pieces of the fifth degree can begin and end at rest, without a jolt."""


def trajectory_tables(trajectory: PiecewisePolynomial, start_time: float) -> tuple[Array, Array]:
    """A trajectory of the formation centre as the numbers that :class:`TrajectoryReference` plays.

    Args:
        trajectory: position (m, shape (2, 1)) over the time since the start (s), of the fifth degree at most.
        start_time: when it starts (s).

    Returns:
        When each piece begins (s), shape (pieces + 2,), and its coefficients of x and of y in rising powers of the
        time since then (m/s^k), shape (pieces + 2, 2, 6). A piece before the trajectory's own holds its start, one
        after them its end; the first counts until the second begins, whenever it is said to begin.
    """
    segments = trajectory.get_number_of_segments()
    coefficients = np.zeros((segments + 2, 2, COEFFICIENTS))
    for i in range(segments):
        for axis in range(2):
            given = trajectory.getPolynomial(i, axis, 0).GetCoefficients()
            coefficients[i + 1, axis, : len(given)] = given
    coefficients[0, :, 0] = trajectory.value(trajectory.start_time()).ravel()
    coefficients[-1, :, 0] = trajectory.value(trajectory.end_time()).ravel()
    return start_time + np.array([trajectory.start_time(), *trajectory.get_segment_times()]), coefficients


def polynomial_motion(time: Scalar, coefficients: list[Scalar]) -> tuple[Scalar, Scalar, Scalar]:
    """Value, first and second derivative of a polynomial, by Horner's rule.

    Args:
        time: since the beginning of the piece (s).
        coefficients: in rising powers of time.
    """
    *lower, value = coefficients
    slope = half_curvature = 0.0 * value
    for coefficient in reversed(lower):
        half_curvature = half_curvature * time + slope
        slope = slope * time + value
        value = value * time + coefficient
    return value, slope, 2.0 * half_curvature


@block_template("TrajectoryReference_", __name__)
def TrajectoryReference_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The reference as a template over double, AutoDiffXd and Expression; see :class:`TrajectoryReference`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A time-varying reference, piece by piece; the first piece counts until the second begins.

        It has no input port: it goes by the clock, and :func:`trajectory_tables` let it rest until the hand-off.
        Output port: ``centre``, the motion of the formation centre [p; ṗ; p̈] (m, m/s, m/s², size 6). Parameters: 0,
        when each piece begins (s); 1, the coefficients of each piece, six of x and six of y in rising powers of the
        time since it began (m/s^k).
        """

        def _construct(self, starts: ArrayLike, coefficients: ArrayLike, *, converter: Any = None) -> None:
            """Make the reference.

            Args:
                starts: when each piece begins (s), ascending, shape (pieces,).
                coefficients: shape (pieces, 2, 6); see :func:`trajectory_tables`.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (starts, coefficients)
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(starts)))
            self.DeclareNumericParameter(BasicVector_[T](np.ravel(coefficients)))
            self.DeclareVectorOutputPort(
                "centre", 6, self._calc_centre, {self.time_ticket(), self.all_parameters_ticket()}
            )

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc_centre(self, context: Any, output: Any) -> None:
            time = context.get_time()
            starts = context.get_numeric_parameter(0).CopyToVector()
            pieces = context.get_numeric_parameter(1).CopyToVector().reshape(len(starts), -1)
            start, *piece = row_at(time, starts.tolist(), np.column_stack([starts, pieces]).tolist())
            motions = [polynomial_motion(time - start, piece[k : k + COEFFICIENTS]) for k in (0, COEFFICIENTS)]
            output.SetFromVector(np.array([axis[k] for k in range(3) for axis in motions]))

    return Impl


TrajectoryReference = in_double(TrajectoryReference_)


class MotionConfig(Section):
    """What every moving reference has."""

    duration: Annotated[
        Positive | None,
        Field(
            description="how long the motion takes from the hand-off (s), the goal held afterwards; chosen: the "
            "transport's duration if not given"
        ),
    ] = None


class Motion(Part):
    """A reference that moves: a subclass says along which trajectory."""

    role = "reference"
    Config = MotionConfig

    def trajectory(self, formation: Formation) -> PiecewisePolynomial:
        """The motion of the formation centre: position (m, shape (2, 1)) over the time since the hand-off (s)."""
        raise NotImplementedError

    def duration(self, formation: Formation) -> float:
        """How long the motion takes (s)."""
        given: float | None = self.config.duration
        return formation.transport_duration if given is None else given

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether it is in time."""
        yield from self.duration_faults(formation)

    def duration_faults(self, formation: Formation) -> Iterator[Fault]:
        """What is wrong with the duration."""
        given, duration, transport = self.config.duration, self.duration(formation), formation.transport_duration
        path: Path = TRANSPORT_DURATION if given is None else ("duration",)
        if duration > transport:
            message = "the motion takes longer than the transport, so the goal is not reached in time"
            yield Fault(path, message, shown(duration), f"at most transport.duration, {transport:g} s")
        elif not SHORTEST <= duration <= LONGEST:
            allowed = f"from {SHORTEST:g} to {LONGEST:g} s, or a set point as reference"
            yield Fault(path, "no duration of a motion", shown(duration), allowed)

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """When each piece begins, and its coefficients."""
        return trajectory_tables(self.trajectory(formation), formation.hand_off)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The reference."""
        return TrajectoryReference(*numbers)


TRANSPORT_DURATION: Path = ("..", "duration")
"""The path of ``transport.duration`` from a reference's own section."""
