"""Carrying a diagram forward: both methods give its solution."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pydrake import symbolic
from pydrake.symbolic import Variable
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder, InputPortSelection, OutputPortSelection
from pydrake.systems.primitives import (
    ConstantVectorSource,
    DiscreteTimeDelay,
    Integrator,
    Linearize,
    LinearSystem,
    Sine,
    SymbolicVectorSystem,
    ZeroOrderHold,
)
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import expm

from drake_formation import build_diagram, load_scenario
from drake_formation.lowering import Status, lower
from drake_formation.lowering.integration import METHODS, Flow

METHOD = pytest.mark.parametrize("method", METHODS)
STIFF = {
    "aggregation.duration": 0,
    "robots.start": {"centre": [2.5, 3.5]},
    "springs.stiffness": 3e4,
    "consensus.delta": 2e4,
    "transport.duration": 20.0,
}


def linear_diagram(matrix, initial):
    builder = DiagramBuilder()
    size = len(matrix)
    plant = LinearSystem(matrix, np.zeros((size, 0)), np.eye(size), np.zeros((size, 0)))
    plant.set_name("plant")
    builder.AddSystem(plant)
    plant.configure_default_state(initial)
    return builder.Build()


def samples(compiled, context, end, **options):
    pieces = list(compiled.integrate(context, end, **options))
    times = np.concatenate([piece.times for piece in pieces])
    return times, np.concatenate([piece.states for piece in pieces]), pieces


@pytest.fixture(scope="module")
def stiff():
    diagram = build_diagram(load_scenario("quadrilateral", overrides=STIFF))
    compiled = lower(diagram)
    tight = samples(compiled, diagram.CreateDefaultContext(), 20.0, accuracy=1e-11, max_step=0.02, at=np.arange(21.0))
    return diagram, compiled, tight[1]


@METHOD
def test_every_second_of_a_stiff_formation(stiff, method):
    diagram, compiled, expected = stiff
    context = diagram.CreateDefaultContext()
    times, states, pieces = samples(
        compiled, context, 20.0, method=method, accuracy=1e-7, max_step=0.5, at=np.arange(21.0)
    )
    np.testing.assert_array_equal(times, np.arange(21.0))
    np.testing.assert_allclose(states.reshape(21, 4, 4)[..., :2], expected.reshape(21, 4, 4)[..., :2], atol=1e-5)
    assert pieces[-1].status == Status.DONE
    assert context.get_time() == 20.0


def test_the_exponential_method_is_not_bound_by_stiffness(stiff):
    diagram, compiled, _ = stiff
    evaluations = {}
    for method in METHODS:
        *_, pieces = samples(
            compiled, diagram.CreateDefaultContext(), 20.0, method=method, max_step=0.5, at=np.arange(21.0)
        )
        evaluations[method] = sum(piece.evaluations for piece in pieces)
    assert evaluations["exponential"] < evaluations["dormand_prince"] / 5


@given(seed=st.integers(0, 2**32 - 1), size=st.integers(1, 4))
@settings(max_examples=10, deadline=None, suppress_health_check=list(HealthCheck))
def test_what_is_linear_is_exact_for_any_step(seed, size):
    rng = np.random.default_rng(seed)
    matrix, initial = rng.normal(size=(size, size)) * 3 - 4 * np.eye(size), rng.normal(size=size)
    diagram = linear_diagram(matrix, initial)
    _, states, _ = samples(lower(diagram), diagram.CreateDefaultContext(), 2.0, method="exponential", max_step=2.0)
    np.testing.assert_allclose(states[-1], expm(2.0 * matrix) @ initial, rtol=1e-6, atol=1e-8)


@METHOD
def test_times_to_sample_at_may_be_anywhere(method):
    matrix, initial = np.array([[0.0, 1.0], [-9.0, -0.1]]), np.array([1.0, 0.0])
    diagram = linear_diagram(matrix, initial)
    at = np.array([0.0, 0.1, 0.25, 0.3, 1.7, 1.8, 1.9, 2.0, 2.718])
    times, states, _ = samples(lower(diagram), diagram.CreateDefaultContext(), 3.0, method=method, accuracy=1e-9, at=at)
    np.testing.assert_array_equal(times, at)
    np.testing.assert_allclose(states, [expm(t * matrix) @ initial for t in at], atol=1e-6)


@METHOD
def test_every_step_is_at_most_the_longest(stiff, method):
    diagram, compiled, expected = stiff
    times, states, _ = samples(compiled, diagram.CreateDefaultContext(), 20.0, method=method, max_step=0.07)
    assert np.diff(times, prepend=0.0).max() <= 0.07 * (1 + 1e-9)
    assert times[-1] == 20.0
    np.testing.assert_allclose(states[-1], expected[-1], atol=1e-4)


@METHOD
def test_fixed_steps(method):
    diagram = linear_diagram(np.array([[-1.0]]), np.array([1.0]))
    times, states, _ = samples(
        lower(diagram), diagram.CreateDefaultContext(), 1.0, method=method, max_step=0.125, adaptive=False
    )
    np.testing.assert_allclose(times, np.arange(1, 9) / 8)
    np.testing.assert_allclose(states[:, 0], np.exp(-times), rtol=1e-6)


@METHOD
def test_more_samples_than_one_piece_holds(method):
    diagram = linear_diagram(np.array([[0.0, 1.0], [-1.0, 0.0]]), np.array([0.0, 1.0]))
    times, states, pieces = samples(lower(diagram), diagram.CreateDefaultContext(), 10.0, method=method, max_step=1e-3)
    assert len(pieces) > 2
    assert np.all(np.diff(times) > 0)
    np.testing.assert_allclose(states[:, 0], np.sin(times), atol=1e-5)


@METHOD
def test_a_state_that_is_lost_is_reported(method):
    overrides = {"consensus.delta": 1e8, "aggregation.duration": 0}
    diagram = build_diagram(load_scenario("line", overrides=overrides))
    context = diagram.CreateDefaultContext()
    context.SetContinuousState(np.full(8, np.nan))
    *_, last = lower(diagram).integrate(context, 1.0, method=method)
    assert last.status == Status.NOT_FINITE


def test_an_unknown_method_is_named(stiff):
    diagram, compiled, _ = stiff
    with pytest.raises(ValueError, match="dormand_prince, exponential"):
        list(compiled.integrate(diagram.CreateDefaultContext(), 1.0, method="steam"))


def test_the_jacobian_is_drakes(stiff):
    diagram, compiled, _ = stiff
    context = diagram.CreateDefaultContext()
    goal = np.array(load_scenario("quadrilateral", overrides=STIFF).transport.goal)
    state = context.get_continuous_state_vector().CopyToVector().reshape(4, 4)
    state[:, :2] += goal - state[:, :2].mean(axis=0)
    context.SetContinuousState(state.ravel())
    flow = Flow(compiled._derivatives, compiled._table, compiled.read(context), compiled._recorder(()))
    expected = Linearize(diagram, context, InputPortSelection.kNoInput, OutputPortSelection.kNoOutput).A()
    np.testing.assert_allclose(flow.jacobian(0.0, state.ravel()), expected, atol=1e-6 * np.abs(expected).max())


STATELESS = {
    "hold": lambda: ZeroOrderHold(0.1, 1),
    "delay": lambda: DiscreteTimeDelay(0.1, 2, 1),
    "discrete linear system": lambda: LinearSystem([[0.5]], [[1.0]], [[1.0]], [[0.0]], 0.1),
    "constant": lambda: ConstantVectorSource([1.0]),
}


@METHOD
@pytest.mark.parametrize("block", STATELESS.values(), ids=STATELESS)
def test_without_continuous_state_the_updates_are_what_there_is(method, block):
    builder = DiagramBuilder()
    system = builder.AddSystem(block())
    if system.num_input_ports():
        builder.ExportInput(system.get_input_port(0), "u")
    builder.ExportOutput(system.get_output_port(0), "y")
    diagram = builder.Build()
    compiled, context = lower(diagram), diagram.CreateDefaultContext()
    simulator = Simulator(diagram)
    for each in (context, simulator.get_mutable_context()):
        if diagram.num_input_ports():
            diagram.get_input_port(0).FixValue(each, [1.0])
    times, states, pieces = samples(compiled, context, 0.95, method=method)
    simulator.AdvanceTo(0.95)
    assert (times[-1], states.shape[1], pieces[-1].status) == (0.95, 0, Status.DONE)
    port = diagram.get_output_port(0)
    np.testing.assert_array_equal(port.Eval(context), port.Eval(simulator.get_context()))


@pytest.mark.parametrize("function", [symbolic.floor, symbolic.ceil])
@METHOD
def test_jumps_of_the_derivatives_are_stepped_over(method, function):
    """ẋ = floor(3 t): the shortest steps of the exponential method are too long for its jumps."""
    time = Variable("t")
    builder = DiagramBuilder()
    builder.AddNamedSystem(
        "stairs", SymbolicVectorSystem(time=time, state=[Variable("x")], dynamics=[function(3 * time)])
    )
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    list(lower(diagram).integrate(context, 2.0, method=method, accuracy=1e-8))
    exact = {symbolic.floor: sum(range(6)) / 3, symbolic.ceil: sum(range(1, 7)) / 3}[function]
    np.testing.assert_allclose(context.get_continuous_state_vector().CopyToVector(), [exact], atol=1e-5)


@METHOD
@pytest.mark.parametrize(
    "at", [[0.3], [0.0, 0.1, 0.3], [0.1, 0.2, 0.30000000000000004, 1.0], [0.5 - 5e-17, 0.95], [1.0 - 1e-16, 1.0]]
)
def test_every_time_asked_for_is_a_sample_also_where_an_update_is_by_a_rounding(method, at):
    builder = DiagramBuilder()
    wave, hold = builder.AddSystem(Sine(1.0, 3.0, 0.0, 1)), builder.AddSystem(ZeroOrderHold(0.1, 1))
    total = builder.AddSystem(Integrator(1))
    builder.Connect(wave.get_output_port(0), hold.get_input_port())
    builder.Connect(hold.get_output_port(), total.get_input_port())
    diagram = builder.Build()
    context = diagram.CreateDefaultContext()
    times, states, _ = samples(lower(diagram), context, 1.0, method=method, at=np.array(at), accuracy=1e-9)
    np.testing.assert_array_equal(times, at)
    held = [sum(np.sin(0.3 * k) * np.clip(t - 0.1 * k, 0, 0.1) for k in range(10)) for t in at]
    np.testing.assert_allclose(states[:, 0], held, atol=1e-9)
    assert context.get_time() == 1.0


@pytest.mark.parametrize("at", [[0.2, 0.1], [0.1, 0.1], [-1.0], [2.0]])
def test_times_out_of_order_or_out_of_reach_are_refused(stiff, at):
    diagram, compiled, _ = stiff
    with pytest.raises(ValueError, match="must rise from 0 s to 1 s"):
        list(compiled.integrate(diagram.CreateDefaultContext(), 1.0, at=np.array(at)))


def test_ringing_shows_between_the_samples_of_the_exponential_method():
    """Read by the cubic through its ends, every step is near the motion; steps are long again where nothing rings."""
    frequency = 80.0
    ringing = np.array([[0.0, 1.0], [-(frequency**2), -0.2]])
    diagram = linear_diagram(ringing, np.array([1e-3, 0.0]))
    times, states, _ = samples(lower(diagram), diagram.CreateDefaultContext(), 60.0, method="exponential")
    middles = (times[1:] + times[:-1]) / 2
    read = CubicHermiteSpline(times, states[:, 0], states[:, 1])(middles)
    exact = [(expm(t * ringing) @ [1e-3, 0.0])[0] for t in middles[::50]]
    np.testing.assert_allclose(read[::50], exact, atol=3e-6)
    assert np.diff(times[-5:]).min() > 3 * np.diff(times[:5]).max()
