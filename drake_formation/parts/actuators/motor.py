"""Motors that exert a limited force, change it at a limited rate, follow late, or do nothing for little."""

from collections.abc import Hashable, Iterator, Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field
from pydrake.systems.framework import BasicVector_, LeafSystem_

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.systems.scalars import Scalar, at_least
from drake_formation.systems.templates import block_template, in_double

Pair = tuple[Scalar, Scalar]
Limit = Annotated[float, Field(gt=0, le=1e9)]
"""A force (N) or its rate (N/s); its square is still a number."""
DeadZone = Annotated[float, Field(ge=0, le=1e9)]
"""A force (N) that may be none."""
Lag = Annotated[float, Field(ge=1e-4, le=1e3)]
"""A time constant (s); with shorter ones a run would do nothing else than follow them."""

FOLLOWING = 0.01
"""Time constant of a force whose rate is limited where none is given (s)."""

MAX_FORCE = "max_force"
FEATURES = ("dead_zone", MAX_FORCE, "time_constant", "max_rate")
"""What motors may lack in perfection, in the order of the block's numbers."""


def beyond_dead_zone(force: Pair, width: Scalar) -> Pair:
    """What a dead zone lets pass of a force: its length is less by the width, and not below 0 (Slotine & Li 1991, 5.2).

    Args:
        force: asked for (N), x and y component.
        width: of the dead zone (N), above 0.
    """
    x, y = force
    share = 1.0 - width / at_least(x * x + y * y, width * width) ** 0.5
    return share * x, share * y


def within_norm(vector: Pair, limit: Scalar) -> Pair:
    """A vector cut to a length, in its direction: v min(1, limit/‖v‖).

    Args:
        vector: x and y component.
        limit: the longest, above 0, in the vector's unit.
    """
    x, y = vector
    share = limit / at_least(x * x + y * y, limit * limit) ** 0.5
    return share * x, share * y


def exerted_at_once(demanded: Pair, numbers: dict[str, Scalar]) -> Pair:
    """The force that motors without inertia exert: what the dead zone lets pass, cut to the largest force.

    Args:
        demanded: force asked for (N), x and y component.
        numbers: of the ``FEATURES`` that there are.
    """
    if "dead_zone" in numbers:
        demanded = beyond_dead_zone(demanded, numbers["dead_zone"])
    if "max_force" in numbers:
        demanded = within_norm(demanded, numbers["max_force"])
    return demanded


def force_rate(force: Pair, demanded: Pair, numbers: dict[str, Scalar]) -> Pair:
    """The rate at which motors change their force (N/s): τ ḟ = u − f, cut to the largest rate.

    The rate limiter of a first-order actuator (Klyde & Mitchell 2004); the shorter τ is, the nearer it comes to one
    that follows every demand which changes slowly enough.

    Args:
        force: f, that they exert (N), x and y component.
        demanded: force asked for (N), from which u follows by :func:`exerted_at_once`.
        numbers: of the ``FEATURES`` that there are, τ among them.
    """
    (fx, fy), (ux, uy) = force, exerted_at_once(demanded, numbers)
    rate = (ux - fx) / numbers["time_constant"], (uy - fy) / numbers["time_constant"]
    return within_norm(rate, numbers["max_rate"]) if "max_rate" in numbers else rate


@block_template("Motor_", __name__)
def Motor_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The motors as a template over double, AutoDiffXd and Expression; see :class:`Motor`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """What the motors of one robot exert.

        Input port: ``demanded``, the force asked of them (N, size 2). Output port: ``force`` (N, size 2). Continuous
        state, with a time constant: that force, 0 at the start. Parameters: 0, the numbers of the features, in order.
        """

        def _construct(self, features: Sequence[str], numbers: ArrayLike, *, converter: Any = None) -> None:
            """Make the motors.

            Args:
                features: those of ``FEATURES`` that there are, at least one.
                numbers: one a feature (N, N, s, N/s).
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (features, numbers)
            self.kind = features  # all else that it computes with is a parameter
            self._features = features
            self._demanded = self.DeclareVectorInputPort("demanded", 2)
            self.DeclareNumericParameter(BasicVector_[T](numbers))
            if "time_constant" in features:
                self.DeclareContinuousState(2)
                # The time keeps the output fresh after a rejected step, as in the plant.
                self.DeclareVectorOutputPort("force", 2, self._calc_followed, {self.xc_ticket(), self.time_ticket()})
            else:
                read = {self.all_input_ports_ticket(), self.all_parameters_ticket()}
                self.DeclareVectorOutputPort("force", 2, self._calc_at_once, read)

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _numbers(self, context: Any) -> dict[str, Scalar]:
            values = context.get_numeric_parameter(0).CopyToVector().tolist()
            return dict(zip(self._features, values, strict=True))

        def _calc_at_once(self, context: Any, output: Any) -> None:
            demanded = self._demanded.Eval(context).tolist()
            output.SetFromVector(np.array(exerted_at_once(demanded, self._numbers(context))))

        def _calc_followed(self, context: Any, output: Any) -> None:
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector())

        def DoCalcTimeDerivatives(self, context: Any, derivatives: Any) -> None:  # noqa: N802 - Drake's name
            if "time_constant" not in self._features:
                return
            force = context.get_continuous_state_vector().CopyToVector().tolist()
            demanded = self._demanded.Eval(context).tolist()
            derivatives.SetFromVector(np.array(force_rate(force, demanded, self._numbers(context))))

    return Impl


Motor = in_double(Motor_)


@part("actuator", kind="motor")
class MotorActuator(Part):
    """Motors with a largest force, a largest rate of it, a first-order lag and a dead zone, as far as given."""

    class Config(Section):
        """What they lack in perfection; nothing by default."""

        max_force: Limit | None = Field(
            default=None, description="largest force ‖u‖ (N), cut in its direction; default: unlimited"
        )
        max_rate: Limit | None = Field(
            default=None,
            description="largest rate ‖u̇‖ of the force (N/s); the force then follows with the time constant, 0.01 s if "
            "there is none; default: unlimited",
        )
        time_constant: Lag | None = Field(
            default=None,
            description="time constant τ (s) with which the force follows what is asked, from 0 at the start; default: "
            "at once",
        )
        dead_zone: DeadZone = Field(
            default=0.0,
            description="dead zone (N): by so much less is exerted than is asked, nothing for less; 0: none",
        )

    @property
    def given(self) -> dict[str, float]:
        """The numbers of the ``FEATURES`` that there are, in their order."""
        config = self.config
        lag = FOLLOWING if config.time_constant is None and config.max_rate is not None else config.time_constant
        values = dict(zip(FEATURES, (config.dead_zone, config.max_force, lag, config.max_rate), strict=True))
        return {name: value for name, value in values.items() if value}

    @property
    def is_smooth(self) -> bool:
        """Whether the force never jumps."""
        return "time_constant" in self.given

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether there is a force between the dead zone and the largest."""
        width, largest = self.config.dead_zone, self.config.max_force
        if largest is not None and width >= largest:
            message = "the dead zone swallows every force that the motors can exert"
            yield Fault(("dead_zone",), message, shown(width), f"below max_force = {largest:g} N")

    def structure(self) -> Hashable:
        """Which features there are."""
        return tuple(self.given)

    def numbers(self, formation: Formation, owner: int) -> Numbers:  # noqa: ARG002
        """Those of the features."""
        return (np.array(list(self.given.values())),) if self.given else ()

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The motors; None where they lack nothing."""
        return Motor(tuple(self.given), *numbers) if self.given else None
