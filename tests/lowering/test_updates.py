"""Updates that are carried out in compiled code are those that Drake's Simulator carries out."""

import numpy as np
import pytest
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from pydrake.systems.framework import BasicVector_, DiagramBuilder, LeafSystem_
from pydrake.systems.primitives import Gain, Integrator, Sine, ZeroOrderHold

from drake_formation.lowering import lower
from drake_formation.systems.sampled_law import SampledLaw
from drake_formation.systems.templates import block_template, in_double


def remember(time, inputs, state, numbers):
    """Keep the last values in a ring, and give the largest times a factor, and when it was looked."""
    place = 2 + int(state[1]) % (state.size - 2)
    state[place] = inputs[0]
    state[1] += 1.0
    state[0] = numbers[0] * state[2:].max() + 0.0 * time


REMEMBER = SampledLaw(remember)


@block_template("LargestOfLast_", __name__)
def LargestOfLast_(T):  # noqa: N802
    class Impl(LeafSystem_[T]):
        def _construct(self, period, length, factor, *, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (period, length, factor)
            self.sampled_law = REMEMBER
            self._input = self.DeclareVectorInputPort("u", 1)
            self.DeclareNumericParameter(BasicVector_[T]([factor]))
            self.DeclareDiscreteState(BasicVector_[T](np.zeros(length + 2)))
            self.DeclarePeriodicDiscreteUpdateEvent(period, 0.0, self._update)
            self.DeclareVectorOutputPort("y", 1, self._calc, {self.xd_ticket()})

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, *other.arguments, converter=converter)

        def _update(self, context, after):
            state = context.get_discrete_state(0).CopyToVector()
            self.sampled_law(
                context.get_time(), self._input.Eval(context), state, context.get_numeric_parameter(0).CopyToVector()
            )
            after.get_mutable_vector(0).SetFromVector(state)

        def _calc(self, context, output):
            output.SetFromVector(context.get_discrete_state(0).CopyToVector()[:1])

    return Impl


LargestOfLast = in_double(LargestOfLast_)


@block_template("Counting_", __name__)
def Counting_(T):  # noqa: N802
    class Impl(LeafSystem_[T]):
        """Its update depends on how often it was called, which no symbol shows."""

        def _construct(self, *, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = ()
            self.calls = 0
            self.DeclareDiscreteState(1)
            self.DeclarePeriodicDiscreteUpdateEvent(0.1, 0.0, self._update)
            self.DeclareVectorOutputPort("y", 1, self._calc, {self.xd_ticket()})

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, converter=converter)

        def _update(self, _context, after):
            self.calls += 1
            after.get_mutable_vector(0).SetFromVector([T(float(self.calls))])

        def _calc(self, context, output):
            output.SetFromVector(context.get_discrete_state(0).CopyToVector())

    return Impl


Counting = in_double(Counting_)


def loop(*middle):
    """x' = −(what some blocks in a row make of x + a sine)."""
    builder = DiagramBuilder()
    state = builder.AddNamedSystem("state", Integrator(1))
    source = state.get_output_port()
    for k, block in enumerate(middle):
        builder.AddNamedSystem(f"block_{k}", block)
        builder.Connect(source, block.get_input_port())
        source = block.get_output_port(0)
    back = builder.AddNamedSystem("back", Gain(-1.0, 1))
    builder.Connect(source, back.get_input_port())
    builder.Connect(back.get_output_port(), state.get_input_port())
    builder.ExportOutput(state.get_output_port(), "x")
    builder.ExportOutput(source, "held")
    return builder.Build()


def ended(diagram, end):
    simulator = Simulator(diagram)
    ResetIntegratorFromFlags(simulator, "runge_kutta5", 0.05)
    simulator.get_mutable_integrator().set_target_accuracy(1e-9)
    simulator.get_mutable_context().SetContinuousState([1.0])
    simulator.AdvanceTo(end)
    context = simulator.get_context()
    return np.concatenate([context.get_continuous_state_vector().CopyToVector(), discrete_of(context)])


def discrete_of(context):
    groups = range(context.num_discrete_state_groups())
    return np.concatenate([context.get_discrete_state().get_vector(k).CopyToVector() for k in groups])


def compiled_end(compiled, end, *stops, **options):
    context = compiled.diagram.CreateDefaultContext()
    context.SetContinuousState([1.0])
    for stop in (*stops, end):
        list(compiled.integrate(context, stop, accuracy=1e-9, max_step=0.05, **options))
    return np.concatenate([context.get_continuous_state_vector().CopyToVector(), discrete_of(context)])


def test_laws_of_arrays_and_traced_updates_go_on_as_in_drake():
    diagram = loop(ZeroOrderHold(0.03, 1), LargestOfLast(0.07, 5, 0.8), ZeroOrderHold(0.11, 1))
    compiled = lower(diagram)
    assert {ticks.period for ticks in compiled._events.ticks} == {0.03, 0.07, 0.11}
    np.testing.assert_allclose(compiled_end(compiled, 2.005), ended(diagram, 2.005), atol=1e-8)


def test_where_a_run_stops_and_goes_on_changes_nothing():
    compiled = lower(loop(ZeroOrderHold(0.03, 1), LargestOfLast(0.07, 5, 0.8)))
    whole = compiled_end(compiled, 2.0)
    np.testing.assert_allclose(compiled_end(compiled, 2.0, 0.0701, 0.21, 1.5), whole, atol=1e-8)


def test_a_changed_parameter_reaches_the_law():
    compiled = lower(loop(LargestOfLast(0.05, 3, 0.5)))
    context = compiled.diagram.CreateDefaultContext()
    context.SetContinuousState([1.0])
    block = compiled.diagram.GetSubsystemByName("block_0")
    block.GetMyMutableContextFromRoot(context).get_mutable_numeric_parameter(0).SetFromVector([0.0])
    list(compiled.integrate(context, 1.0))
    assert context.get_continuous_state_vector().GetAtIndex(0) == 1.0


def test_an_update_that_symbols_do_not_show_is_left_to_drake():
    builder = DiagramBuilder()
    counting, total = builder.AddNamedSystem("counting", Counting()), builder.AddNamedSystem("total", Integrator(1))
    hold = builder.AddNamedSystem("hold", ZeroOrderHold(0.05, 1))
    builder.Connect(counting.get_output_port(), hold.get_input_port())
    builder.Connect(hold.get_output_port(), total.get_input_port())
    diagram = builder.Build()
    compiled, context = lower(diagram), diagram.CreateDefaultContext()
    assert [ticks.period for ticks in compiled._events.ticks] == [0.05]
    counting.calls = 0
    list(compiled.integrate(context, 1.0))
    assert counting.calls == 10
    seen = [0, *np.repeat(np.arange(1, 11), 2)[:-1]]  # a hold that is due with it sees what was there before
    assert context.get_continuous_state_vector().GetAtIndex(0) == pytest.approx(0.05 * sum(seen))


def test_what_is_recorded_is_what_the_ports_show():
    diagram = loop(ZeroOrderHold(0.1, 1))
    compiled, context = lower(diagram), diagram.CreateDefaultContext()
    context.SetContinuousState([1.0])
    at = np.array([0.0, 0.05, 0.1, 0.15, 0.25])
    pieces = list(compiled.integrate(context, 0.3, at=at, record=("x", "held")))
    times = np.concatenate([piece.times for piece in pieces])
    x, held = np.concatenate([piece.recorded for piece in pieces]).T
    np.testing.assert_array_equal(times, at)
    np.testing.assert_allclose(x, [1.0, 0.95, 0.9, 0.855, 0.81 - 0.05 * 0.81], atol=1e-12)
    np.testing.assert_allclose(held, [1.0, 1.0, 0.9, 0.9, 0.81], atol=1e-12)


def test_a_run_of_many_steps_comes_in_pieces():
    builder = DiagramBuilder()
    source, hold = builder.AddSystem(Sine(1.0, 7.0, 0.0, 1)), builder.AddSystem(ZeroOrderHold(1e-3, 1))
    total = builder.AddSystem(Integrator(1))
    builder.Connect(source.get_output_port(0), hold.get_input_port())
    builder.Connect(hold.get_output_port(), total.get_input_port())
    diagram = builder.Build()
    compiled, context = lower(diagram), diagram.CreateDefaultContext()
    pieces = list(compiled.integrate(context, 10.0))
    assert len(pieces) > 2
    exact = 1e-3 * np.sin(7.0 * 1e-3 * np.arange(10_000)).sum()
    assert context.get_continuous_state_vector().GetAtIndex(0) == pytest.approx(exact, abs=1e-10)
