"""The compiled diagram computes what the diagram computes."""

import math

import numpy as np
import pytest
import strategies
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from probe import context_at
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder, LeafSystem, LeafSystem_
from pydrake.systems.primitives import (
    Adder,
    ConstantVectorSource,
    Gain,
    Integrator,
    LinearSystem,
    Multiplexer,
    PassThrough,
    Sine,
    TrajectorySource,
    ZeroOrderHold,
)
from pydrake.trajectories import PiecewisePolynomial

from drake_formation import build_diagram, load_scenario, set_parameters
from drake_formation.lowering import LoweringError, lower
from drake_formation.systems.templates import block_template

EXACT = {"rtol": 1e-12, "atol": 1e-12}

few = settings(max_examples=5, deadline=None, suppress_health_check=list(HealthCheck))


def same_derivatives(compiled, diagram, context):
    state = context.get_continuous_state_vector().CopyToVector()
    expected = diagram.EvalTimeDerivatives(context).CopyToVector()
    found = compiled.derivatives(context.get_time(), state, compiled.read(context))
    scale = max(1.0, np.abs(expected).max())
    np.testing.assert_allclose(found / scale, expected / scale, **EXACT)


@pytest.mark.slow
@few
@given(st.data())
def test_derivatives_are_the_diagrams(data):
    structure = data.draw(strategies.structures())
    scenario, other = (data.draw(strategies.numbers(structure)) for _ in range(2))
    rng = data.draw(strategies.generators)
    diagram = build_diagram(scenario)
    compiled = lower(diagram)
    for numbers in (scenario, other):
        context = context_at(diagram, strategies.random_state(numbers, rng))
        set_parameters(diagram, context, numbers)
        same_derivatives(compiled, diagram, context)


@pytest.mark.parametrize("name", ["line", "quadrilateral", "octagon"])
@pytest.mark.parametrize("phase", [0.0, 1.0])
def test_both_phases_of_the_shipped_scenarios(name, phase):
    diagram = build_diagram(load_scenario(name))
    compiled = lower(diagram)
    context = diagram.CreateDefaultContext()
    diagram.GetSubsystemByName("phase").GetMyMutableContextFromRoot(context).SetDiscreteState([phase])
    rng = np.random.default_rng(0)
    state = context.get_continuous_state_vector().CopyToVector()
    for _ in range(5):
        context.SetTimeAndContinuousState(rng.uniform(0, 100), state + rng.uniform(-0.1, 0.1, len(state)))
        same_derivatives(compiled, diagram, context)


@pytest.mark.slow
def test_outputs_are_the_diagrams():
    diagram = build_diagram(load_scenario("quadrilateral", overrides={"avoidance.sensing": "nearest"}))
    compiled = lower(diagram)
    context = diagram.CreateDefaultContext()
    names = [diagram.get_output_port(k).get_name() for k in range(diagram.num_output_ports())]
    state = context.get_continuous_state_vector().CopyToVector()
    values = compiled.outputs(names, np.zeros(1), state[None], compiled.read(context))
    for name in names:
        np.testing.assert_allclose(values[name][0], diagram.GetOutputPort(name).Eval(context), **EXACT)


def loop_of_drakes_own_blocks():
    """Drake's own blocks, nested, two gains that differ in what is no parameter, and one sampled block."""
    inner = DiagramBuilder()
    low, high = (inner.AddNamedSystem(f"gain_{k}", Gain(k, 2)) for k in (2.0, -3.0))
    both = inner.AddNamedSystem("both", Adder(2, 2))
    for k, gain in enumerate((low, high)):
        inner.Connect(gain.get_output_port(), both.get_input_port(k))
    inner.ExportInput(low.get_input_port(), "u")
    inner.ConnectInput("u", high.get_input_port())
    inner.ExportOutput(both.get_output_port(), "y")
    builder = DiagramBuilder()
    nested = builder.AddNamedSystem("nested", inner.Build())
    plant = builder.AddNamedSystem("plant", LinearSystem([[0, 1], [-4, 0]], np.eye(2), np.eye(2), np.zeros((2, 2))))
    hold = builder.AddNamedSystem("hold", ZeroOrderHold(0.3, 2))
    through = builder.AddNamedSystem("through", PassThrough(2))
    builder.Connect(plant.get_output_port(), hold.get_input_port())
    builder.Connect(hold.get_output_port(), through.get_input_port())
    builder.Connect(through.get_output_port(), nested.get_input_port())
    builder.Connect(nested.get_output_port(), plant.get_input_port())
    builder.ExportOutput(hold.get_output_port(), "held")
    return builder.Build()


def test_any_diagram_of_blocks_that_trace():
    diagram = loop_of_drakes_own_blocks()
    compiled = lower(diagram)
    context, expected = diagram.CreateDefaultContext(), diagram.CreateDefaultContext()
    for each in (context, expected):
        each.SetContinuousState([1.0, 0.0])
    *_, last = compiled.integrate(context, 2.0, accuracy=1e-10, max_step=0.05)
    simulator = Simulator(diagram, expected)
    simulator.get_mutable_integrator().set_target_accuracy(1e-10)
    simulator.get_mutable_integrator().set_maximum_step_size(0.01)
    simulator.AdvanceTo(2.0)
    assert context.get_time() == last.times[-1] == 2.0
    np.testing.assert_allclose(
        last.states[-1], simulator.get_context().get_continuous_state_vector().CopyToVector(), rtol=0, atol=1e-7
    )


def test_dense_output_follows_the_solution():
    builder = DiagramBuilder()
    wave = builder.AddNamedSystem("wave", Sine(1.0, 2.0, 0.0, 1))
    plant = builder.AddNamedSystem("plant", Integrator(1))
    builder.Connect(wave.get_output_port(0), plant.get_input_port())
    diagram = builder.Build()
    at = np.linspace(0, 5, 37)
    pieces = list(lower(diagram).integrate(diagram.CreateDefaultContext(), 5.0, accuracy=1e-9, at=at))
    np.testing.assert_array_equal(np.concatenate([piece.times for piece in pieces]), at)
    np.testing.assert_allclose(
        np.concatenate([piece.states for piece in pieces])[:, 0], (1 - np.cos(2 * at)) / 2, rtol=0, atol=1e-7
    )


class OnlyDouble(LeafSystem):
    """Converts to no other scalar."""

    def __init__(self):
        super().__init__()
        self.DeclareContinuousState(1)

    def DoCalcTimeDerivatives(self, context, derivatives):  # noqa: N802
        derivatives.SetFromVector([1.0])


def test_what_does_not_convert_is_named():
    builder = DiagramBuilder()
    builder.AddNamedSystem("awkward", OnlyDouble())
    with pytest.raises(LoweringError, match=r"'awkward'.*does not convert"):
        lower(builder.Build())


@block_template("Lawful_", __name__)
def Lawful_(T):  # noqa: N802 - Drake's name for a template
    class Impl(LeafSystem_[T]):
        def _construct(self, law, *, converter=None):
            LeafSystem_[T].__init__(self, converter=converter)
            self.arguments = (law,)
            self.DeclareContinuousState(1)

        def _construct_copy(self, other, converter=None):
            Impl._construct(self, *other.arguments, converter=converter)

        def DoCalcTimeDerivatives(self, context, derivatives):  # noqa: N802 - Drake's name
            (law,) = self.arguments
            derivatives.SetFromVector([law(context.get_continuous_state_vector())])

    return Impl


ADVICE = {
    "maximum": (lambda x: np.maximum(x.CopyToVector()[0], 0.0), "if_then_else"),
    "clip": (lambda x: np.clip(x.CopyToVector()[0], 0.0, 1.0), "if_then_else"),
    "if": (lambda x: 1.0 if x.CopyToVector()[0] > 0 else 0.0, "if_then_else"),
    "max": (lambda x: max(x.CopyToVector()[0], 0.0), "if_then_else"),
    "math": (lambda x: math.sin(x.CopyToVector()[0]), "NumPy's"),
}


@pytest.mark.parametrize(("law", "advice"), ADVICE.values(), ids=ADVICE)
def test_what_symbols_cannot_do_is_told_with_what_to_write_instead(law, advice):
    builder = DiagramBuilder()
    builder.AddNamedSystem("lawful", Lawful_[float](law))
    with pytest.raises(LoweringError, match=f"'lawful'.*does not run in symbols.*{advice}") as refusal:
        lower(builder.Build())
    assert "__bool__" not in str(refusal.value)


def test_a_trajectory_source_is_told_what_plays_one():
    builder = DiagramBuilder()
    curve = PiecewisePolynomial.FirstOrderHold([0.0, 1.0], [[0.0, 1.0]])
    source, plant = builder.AddNamedSystem("curve", TrajectorySource(curve)), builder.AddSystem(Integrator(1))
    builder.Connect(source.get_output_port(), plant.get_input_port())
    with pytest.raises(LoweringError, match=r"'curve'.*TrajectoryReference"):
        lower(builder.Build())


def test_a_fixed_value_on_a_connected_port_is_refused_by_name():
    """Drake lets it take the connection's place."""
    builder = DiagramBuilder()
    wave, plant = builder.AddNamedSystem("wave", Sine(1.0, 2.0, 0.0, 1)), builder.AddNamedSystem("plant", Integrator(1))
    builder.Connect(wave.get_output_port(0), plant.get_input_port())
    diagram = builder.Build()
    compiled, context = lower(diagram), diagram.CreateDefaultContext()
    list(compiled.integrate(context, 0.5))
    own = plant.GetMyMutableContextFromRoot(context)
    plant.get_input_port().FixValue(own, wave.get_output_port(0).Eval(wave.GetMyContextFromRoot(context)))
    with pytest.raises(LoweringError, match=r"'plant'.*input port 'u0?' is connected, and has a fixed value"):
        list(compiled.integrate(context, 1.0))
    with pytest.raises(LoweringError, match="'plant'"):
        compiled.read(context)


def test_ports_of_no_size_are_carried_along():
    builder = DiagramBuilder()
    empty = builder.AddNamedSystem("empty", ConstantVectorSource([]))
    joined = builder.AddNamedSystem("joined", Multiplexer([0, 1]))
    plant = builder.AddNamedSystem("plant", LinearSystem([[0.0]], [[-1.0]], [[1.0]], [[0.0]]))
    builder.Connect(empty.get_output_port(), joined.get_input_port(0))
    builder.Connect(plant.get_output_port(), joined.get_input_port(1))
    builder.Connect(joined.get_output_port(0), plant.get_input_port())
    plant.configure_default_state([1.0])
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    list(lower(diagram).integrate(context, 1.0, accuracy=1e-10))
    np.testing.assert_allclose(context.get_continuous_state_vector().CopyToVector(), [np.exp(-1.0)], rtol=1e-8)
