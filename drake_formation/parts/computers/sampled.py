"""A digital computer: control forces worked out at times and held in between (Åström & Wittenmark 1997, Ch. 1)."""

import math
from collections.abc import Hashable, Iterator
from typing import Any

import numpy as np
from pydantic import Field
from pydrake.systems.framework import DiagramBuilder, LeafSystem_, System

from drake_formation.config.errors import Fault, shown
from drake_formation.config.values import NonNegative, Period, Section
from drake_formation.formation.formation import Formation
from drake_formation.parts.part import Numbers, Part
from drake_formation.parts.registry import part
from drake_formation.systems.templates import block_template, in_double

MOST_BEHIND = 1000
"""Samples that may be on their way at once."""
ROUNDING = 1e-9
"""Share of a period below which a delay is taken to be whole periods."""


@block_template("DelayedHold_", __name__)
def DelayedHold_(T: Any) -> Any:  # noqa: N802 - Drake's name for a template
    """The hold as a template over double, AutoDiffXd and Expression; see :class:`DelayedHold`."""

    class Impl(LeafSystem_[T]):  # type: ignore[misc]
        """A zero-order hold that may be some samples behind.

        Input port: ``asked`` (N, size 2), looked at at the times offset + k period. Output port: ``demanded`` (N, size
        2), what was seen some samples before the last, 0 at first. Discrete state: the samples on their way, newest
        first, and the one given.
        """

        def _construct(self, period: float, offset: float, behind: int = 0, *, converter: Any = None) -> None:
            """Make the hold.

            Args:
                period: between samples (s).
                offset: when the first is taken (s).
                behind: how many newer samples there are than the one given.
                converter: for Drake's scalar conversion.
            """
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (period, offset, behind)
            self.kind = self.arguments
            self._asked = self.DeclareVectorInputPort("asked", 2)
            self.DeclareDiscreteState(2 * (behind + 1))
            self.DeclarePeriodicDiscreteUpdateEvent(period, offset, self._sample)
            self.DeclareVectorOutputPort("demanded", 2, self._calc_demanded, {self.xd_ticket()})

        def _construct_copy(self, other: Any, converter: Any = None) -> None:
            Impl._construct(self, *other.arguments, converter=converter)

        def _sample(self, context: Any, samples: Any) -> None:
            before = context.get_discrete_state(0).CopyToVector().tolist()
            samples.set_value(np.array([*self._asked.Eval(context).tolist(), *before[:-2]]))

        def _calc_demanded(self, context: Any, output: Any) -> None:
            output.SetFromVector(context.get_discrete_state(0).CopyToVector()[-2:])

    return Impl


DelayedHold = in_double(DelayedHold_)


def delayed_hold(period: float, phase: float, delay: float) -> System:
    """A hold whose samples take a time to come out: one hold, and where that is no whole periods another behind it.

    Args:
        period: T between samples (s).
        phase: when the first is taken (s).
        delay: until a sample is given (s).
    """
    behind = math.floor(delay / period + ROUNDING)
    rest = delay - behind * period
    if rest <= ROUNDING * period:
        hold: System = DelayedHold(period, phase, behind)
        return hold
    builder = DiagramBuilder()
    taken = builder.AddNamedSystem("taken", DelayedHold(period, phase))
    given = builder.AddNamedSystem("given", DelayedHold(period, phase + rest, behind))
    builder.Connect(taken.get_output_port(), given.get_input_port())
    builder.ExportInput(taken.get_input_port(), "asked")
    builder.ExportOutput(given.get_output_port(), "demanded")
    return builder.Build()


@part("computer", kind="sampled")
class SampledComputer(Part):
    """The sum of the control forces worked out every period and held, with a phase and a delay of its own."""

    class Config(Section):
        """When it looks, and when it is done."""

        period: Period = Field(default=0.01, description="sampling period T (s), counted from time 0; chosen: 0.01")
        phase: NonNegative = Field(
            default=0.0,
            description="when it looks for the first time (s), below the period; what is sampled at the same moment, "
            "as by sensors, it still sees as before; no force is asked for earlier; chosen: 0",
        )
        delay: NonNegative = Field(
            default=0.0, description="time (s) from looking until the force is asked for, as computing takes; chosen: 0"
        )

    def checks(self, formation: Formation, owner: int) -> Iterator[Fault]:  # noqa: ARG002
        """Whether phase and delay go with the period."""
        config, most = self.config, MOST_BEHIND * self.config.period
        if config.phase >= config.period:
            yield Fault(("phase",), "not within a period", shown(config.phase), f"below period = {config.period:g} s")
        if config.delay > most:
            message = f"more than {MOST_BEHIND} samples would be on their way"
            yield Fault(("delay",), message, shown(config.delay), f"at most {most:g} s, or a longer period")

    def structure(self) -> Hashable:
        """Period, phase and delay, which a block is made with."""
        config = self.config
        return config.period, config.phase, config.delay

    def ticks(self) -> tuple[tuple[float, float], ...]:
        """When it asks for another force."""
        return ((self.config.period, self.config.phase + self.config.delay),)

    def block(self, formation: Formation, owner: int, numbers: Numbers) -> Any:  # noqa: ARG002
        """The computer."""
        return delayed_hold(self.config.period, self.config.phase, self.config.delay)
