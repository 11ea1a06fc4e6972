"""Small random diagrams of Drake's blocks and of users', nested, sampled, with loops; some with what is refused."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from pydrake.common.value import Value
from pydrake.systems.framework import BasicVector_, DiagramBuilder, LeafSystem, LeafSystem_
from pydrake.systems.primitives import (
    Adder,
    ConstantVectorSource,
    Demultiplexer,
    DiscreteDerivative,
    DiscreteTimeDelay,
    FirstOrderLowPassFilter,
    Gain,
    Integrator,
    LinearSystem,
    LogVectorOutput,
    MatrixGain,
    Multiplexer,
    PassThrough,
    Saturation,
    Sine,
    ZeroOrderHold,
)

from drake_formation.systems.scalars import positive_part
from drake_formation.systems.templates import block_template, in_double

SIXTEENTH = 1 / 16
"""Periods and offsets are multiples of it, exact in binary: Drake's Simulator misses none of these."""


@block_template("Sampled_", __name__)
def Sampled_(T):  # noqa: N802 - Drake's name for a template
    class Impl(LeafSystem_[T]):
        """Two groups of discrete state, of which one may be empty, updated at a period; events by another's hand."""

        def _construct(self, size, period, offset, declare=None, *, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (size, period, offset, declare)
            self._input = self.DeclareVectorInputPort("u", size)
            self.DeclareDiscreteState(BasicVector_[T](np.zeros(size)))
            self.DeclareDiscreteState(BasicVector_[T](np.ones(1)))
            self.DeclareNumericParameter(BasicVector_[T]([0.5]))
            declare_update(self, period, offset, self._update)
            if declare:
                declare(self)
            self.DeclareVectorOutputPort("y", size, self._calc, {self.xd_ticket(), self.all_parameters_ticket()})

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, *other.arguments, converter=converter)

        def _update(self, context, discrete):
            (share,) = context.get_numeric_parameter(0).CopyToVector()
            old, (count,) = (context.get_discrete_state().get_vector(k).CopyToVector() for k in range(2))
            discrete.get_mutable_vector(0).SetFromVector(old + share * (self._input.Eval(context) - old))
            discrete.get_mutable_vector(1).SetFromVector([count + 1.0])

        def _calc(self, context, output):
            values, (count,) = (context.get_discrete_state().get_vector(k).CopyToVector() for k in range(2))
            output.SetFromVector(values + 0.01 * count)

        def react(self, context, *changed):
            for one in changed:
                if hasattr(one, "get_mutable_vector"):
                    one.get_mutable_vector(1).SetFromVector([2.0])

    return Impl


@block_template("Pushed_", __name__)
def Pushed_(T):  # noqa: N802 - Drake's name for a template
    class Impl(LeafSystem_[T]):
        """Continuous state that depends on time, on a parameter, and on the positive part of its input."""

        def _construct(self, size, *, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (size,)
            self._input = self.DeclareVectorInputPort("u", size)
            self.DeclareContinuousState(BasicVector_[T](np.zeros(size)))
            self.DeclareNumericParameter(BasicVector_[T]([1.5]))
            self.DeclareVectorOutputPort("y", size, self._calc, {self.xc_ticket(), self.time_ticket()})

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, *other.arguments, converter=converter)

        def _calc(self, context, output):
            output.SetFromVector(context.get_continuous_state_vector().CopyToVector() + 0.1 * context.get_time())

        def DoCalcTimeDerivatives(self, context, derivatives):  # noqa: N802 - Drake's name
            (rate,) = context.get_numeric_parameter(0).CopyToVector()
            state = context.get_continuous_state_vector().CopyToVector()
            push = np.array([positive_part(u) for u in self._input.Eval(context)])
            derivatives.SetFromVector(push - rate * state)

    return Impl


Sampled, Pushed = in_double(Sampled_), in_double(Pushed_)


def declare_update(block, period, offset, update):
    """Declares for another: nothing of it stands in the block's own code."""
    block.DeclarePeriodicDiscreteUpdateEvent(period, offset, update)


class Observer(LeafSystem):
    """A block that is no template."""

    def __init__(self, size):
        super().__init__()
        self.DeclareVectorInputPort("u", size)
        self.DeclareVectorOutputPort("y", size, lambda context, output: None)


class Abstract(LeafSystem):
    def __init__(self, size):
        super().__init__()
        self.DeclareVectorInputPort("u", size)
        self.DeclareAbstractState(Value("text"))
        self.DeclareVectorOutputPort("y", size, lambda context, output: None)


REFUSED = {
    "every step": lambda s: s.DeclarePerStepDiscreteUpdateEvent(s.react),
    "unrestricted in every step": lambda s: s.DeclarePerStepUnrestrictedUpdateEvent(s.react),
    "initialization": lambda s: s.DeclareInitializationDiscreteUpdateEvent(s.react),
    "unrestricted initialization": lambda s: s.DeclareInitializationUnrestrictedUpdateEvent(s.react),
    "another period": lambda s: s.DeclarePeriodicDiscreteUpdateEvent(3 * SIXTEENTH, SIXTEENTH, s.react),
    "unrestricted": lambda s: s.DeclarePeriodicUnrestrictedUpdateEvent(SIXTEENTH, 0.0, s.react),
    "publishing": lambda s: s.DeclarePeriodicPublishEvent(SIXTEENTH, 0.0, s.react),
    "publishing every step": lambda s: s.DeclarePerStepPublishEvent(s.react),
}
"""What a block may declare and a compiled run leaves out."""

INERT = {"forced": lambda s: s.DeclareForcedDiscreteUpdateEvent(s.react)}


@dataclass
class Example:
    """A diagram, and what of it is refused, by the block's name."""

    diagram: Any
    logs: list[Any]
    refused: set[str] = field(default_factory=set)


class _Builder:
    def __init__(self, rng):
        self.rng, self.size = rng, int(rng.integers(1, 3))
        self.builder = DiagramBuilder()
        self.outputs, self.open, self.refused, self.count = [], [], set(), 0

    def pick(self, choices):
        return choices[self.rng.integers(len(choices))]

    def period(self):
        return SIXTEENTH * int(self.rng.integers(1, 6)), SIXTEENTH * int(self.rng.integers(0, 4))

    def stable(self, discrete):
        a = self.rng.uniform(-1, 1, (self.size, self.size))
        return 0.4 * a if discrete else a - 2 * np.eye(self.size)

    def add(self, block, name=""):
        self.count += 1
        return self.builder.AddNamedSystem(f"{name or type(block).__name__.lower()}_{self.count}", block)

    def source(self):
        rng, n = self.rng, self.size
        block = self.pick(
            [
                lambda: Sine(float(rng.uniform(0.5, 1)), float(rng.uniform(1, 4)), float(rng.uniform(0, 1)), n),
                lambda: ConstantVectorSource(rng.uniform(-1, 1, n)),
                lambda: Gain(2.0, n),
            ]
        )()
        added = self.add(block)
        if added.num_input_ports():
            self.builder.ExportInput(added.get_input_port(), f"u_{self.count}")
        self.outputs.append(added.get_output_port(0))

    def holder(self):
        """A block whose output does not wait for its input, so that it may stand in a loop."""
        n, (period, offset), eye, zero = self.size, self.period(), np.eye(self.size), np.zeros((self.size, self.size))
        block = self.pick(
            [
                lambda: Integrator(n),
                lambda: FirstOrderLowPassFilter(0.7, n),
                lambda: LinearSystem(self.stable(False), eye, eye, zero),
                lambda: LinearSystem(self.stable(True), eye, eye, zero, period),
                lambda: ZeroOrderHold(period, n, offset),
                lambda: DiscreteTimeDelay(period, int(self.rng.integers(1, 4)), n),
                lambda: Sampled(n, period, offset, self.pick([None, *INERT.values()])),
                lambda: Pushed(n),
                self.nested,
            ]
        )()
        added = self.add(block)
        self.outputs.append(added.get_output_port(0))
        self.open.append(added.get_input_port(0))

    def nested(self):
        """A diagram in the diagram: a filter behind a gain."""
        inner = DiagramBuilder()
        gain = inner.AddNamedSystem("gain", Gain(float(self.rng.uniform(0.2, 1)), self.size))
        low_pass = inner.AddNamedSystem("low_pass", FirstOrderLowPassFilter(0.4, self.size))
        inner.Connect(gain.get_output_port(), low_pass.get_input_port())
        inner.ExportInput(gain.get_input_port(), "u")
        inner.ExportOutput(low_pass.get_output_port(), "y")
        return inner.Build()

    def function(self):
        n = self.size
        block = self.pick(
            [
                lambda: Adder(2, n),
                lambda: Saturation(-0.5 * np.ones(n), 0.5 * np.ones(n)),
                lambda: MatrixGain(self.rng.uniform(-0.5, 0.5, (n, n))),
                lambda: PassThrough(n),
                lambda: DiscreteDerivative(n, self.period()[0], suppress_initial_transient=False),
                lambda: Gain(float(self.rng.uniform(-0.8, 0.8)), n),
            ]
        )()
        added = self.add(block)
        for k in range(added.num_input_ports()):
            self.builder.Connect(self.pick(self.outputs), added.get_input_port(k))
        self.outputs.append(added.get_output_port(0))

    def split_and_joined(self):
        """Numbers taken apart and put together."""
        apart, together = self.add(Demultiplexer(self.size, 1)), self.add(Multiplexer(self.size))
        self.builder.Connect(self.pick(self.outputs), apart.get_input_port(0))
        for k in range(self.size):
            self.builder.Connect(apart.get_output_port(k), together.get_input_port(self.size - 1 - k))
        self.outputs.append(together.get_output_port(0))

    def awkward(self):
        name, block = self.pick([
            *((f"awkward_{k}", lambda declare=d: Sampled(self.size, *self.period(), declare)) for k, d in enumerate(
                REFUSED.values())),
            ("observer", lambda: Observer(self.size)),
            ("abstract", lambda: Abstract(self.size)),
        ])  # fmt: skip
        added = self.add(block(), name)
        self.builder.Connect(self.pick(self.outputs), added.get_input_port(0))
        self.refused.add(added.get_name())

    def build(self):
        rng = self.rng
        for _ in range(rng.integers(1, 3)):
            self.source()
        for _ in range(rng.integers(0, 4)):
            self.holder()
        for _ in range(rng.integers(0, 4)):
            self.function()
        if rng.random() < 0.3:
            self.split_and_joined()
        for port in self.open:
            self.builder.Connect(self.pick(self.outputs), port)
        if rng.random() < 0.15:
            self.awkward()
        logs = []
        if rng.random() < 0.3:
            logs.append(LogVectorOutput(self.pick(self.outputs), self.builder, self.period()[0]))
        self.builder.ExportOutput(self.outputs[-1], "y")
        return Example(self.builder.Build(), logs, self.refused)


def example(seed):
    """The diagram of a seed."""
    return _Builder(np.random.default_rng(seed)).build()
