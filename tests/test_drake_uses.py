"""What README, notebooks and docstrings say can be done with the diagram in plain Drake is done here."""

import numpy as np
import pytest
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, InitializeAutoDiff
from pydrake.symbolic import Expression, Variable
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import FirstOrderTaylorApproximation, Linearize, LogVectorOutput

from drake_formation import build_diagram, load_scenario, set_parameters, simulate, with_overrides
from drake_formation.analysis import at_rest, linearize
from drake_formation.parameters import find_block
from drake_formation.scenario import shipped_scenarios

SHORT = {"aggregation.duration": 1.0, "transport.duration": 1.0}


@pytest.fixture
def scenario():
    return load_scenario("line", overrides=SHORT)


def state(context):
    return context.get_continuous_state_vector().CopyToVector()


def advanced(diagram, time, context=None):
    simulator = Simulator(diagram, context)
    simulator.AdvanceTo(time)
    return state(simulator.get_context())


def test_simulator(scenario):
    expected = simulate(scenario, engine="compiled")["position"].values[-1]
    found = advanced(build_diagram(scenario), 2.0).reshape(-1, 4)[:, :2]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize("name", shipped_scenarios())
def test_linearize_at_rest(name):
    scenario = load_scenario(name)
    diagram = build_diagram(at_rest(scenario))
    found = Linearize(diagram, diagram.CreateDefaultContext()).A()
    np.testing.assert_allclose(found, linearize(scenario).A, rtol=0, atol=1e-9)


def test_linearize_takes_no_hand_off(scenario):
    """Drake ends Python for it, which is why README and docstrings say so; where this fails, they need not any more."""
    diagram = build_diagram(scenario)
    with pytest.raises(SystemExit, match="has_only_continuous_state"):
        Linearize(diagram, diagram.CreateDefaultContext())


def test_first_order_taylor_approximation_on_the_way(scenario):
    diagram = build_diagram(with_overrides(scenario, {"aggregation.duration": 0.0}))
    context = diagram.CreateDefaultContext()
    advanced(diagram, 1.0, context)
    slope = diagram.EvalTimeDerivatives(context).CopyToVector()
    linear = FirstOrderTaylorApproximation(diagram, context)
    np.testing.assert_allclose(linear.A() @ state(context) + linear.f0(), slope, rtol=0, atol=1e-9)


def test_to_autodiff_gives_gradients_by_parameters(scenario):
    diagram = build_diagram(scenario)
    other = diagram.ToAutoDiffXd()
    context = other.CreateDefaultContext()
    mass = find_block(other, "robot_1/plant").GetMyMutableContextFromRoot(context).get_mutable_numeric_parameter(0)
    mass.SetFromVector([AutoDiffXd(40.0, [1.0])])
    found = ExtractGradient(other.EvalTimeDerivatives(context).CopyToVector().reshape(-1, 1)).ravel()
    slope = diagram.EvalTimeDerivatives(diagram.CreateDefaultContext()).CopyToVector()
    np.testing.assert_allclose(found[2:4], -slope[2:4] / 40.0, rtol=1e-9)  # v' = F / m


def test_autodiff_is_simulated_too(scenario):
    """The gradient of where the run ends by where it starts, against differences."""
    diagram = build_diagram(scenario)
    start = state(diagram.CreateDefaultContext())
    other = diagram.ToAutoDiffXd()
    from pydrake.systems.analysis import Simulator_

    simulator = Simulator_[AutoDiffXd](other)
    simulator.get_mutable_context().SetContinuousState(InitializeAutoDiff(start).ravel())
    simulator.AdvanceTo(1.5)
    found = ExtractGradient(state(simulator.get_context()).reshape(-1, 1))
    for k in range(2):
        ends = []
        for step in (1e-4, -1e-4):
            context = diagram.CreateDefaultContext()
            context.SetContinuousState(start + step * np.eye(len(start))[k])
            ends.append(advanced(diagram, 1.5, context))
        np.testing.assert_allclose(found[:, k], (ends[0] - ends[1]) / 2e-4, rtol=0, atol=1e-3)


def test_to_symbolic_gives_the_equations_of_motion(scenario):
    diagram = build_diagram(scenario)
    symbolic = diagram.ToSymbolic()
    context = symbolic.CreateDefaultContext()
    numbers = state(diagram.CreateDefaultContext())
    variables = [Variable(f"x{k}") for k in range(len(numbers))]
    context.SetContinuousState([Expression(variable) for variable in variables])
    environment = dict(zip(variables, numbers, strict=True))
    found = [x.Evaluate(environment) for x in symbolic.EvalTimeDerivatives(context).CopyToVector()]
    expected = diagram.EvalTimeDerivatives(diagram.CreateDefaultContext()).CopyToVector()
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12)


def test_graphviz(scenario):
    text = build_diagram(scenario).GetGraphvizString(max_depth=2)
    for name in ("robot_1", "robot_2", "plant", "tracking", "consensus", "avoidance", "reference", "phase"):
        assert name in text


def test_set_parameters_without_a_rebuild(scenario):
    other = with_overrides(scenario, {"springs.stiffness": 300.0, "robots.mass": [30.0, 50.0]})
    diagram = build_diagram(scenario)
    context = diagram.CreateDefaultContext()
    set_parameters(diagram, context, other)
    np.testing.assert_array_equal(advanced(diagram, 2.0, context), advanced(build_diagram(other), 2.0))


def test_set_parameters_inside_another_diagram_and_between_steps(scenario):
    other = with_overrides(scenario, {"consensus.delta": 40.0})
    alone = build_diagram(scenario)
    context = alone.CreateDefaultContext()
    advanced(alone, 1.5, context)
    set_parameters(alone, context, other)
    builder = DiagramBuilder()
    formation = builder.AddSystem(build_diagram(scenario))
    simulator = Simulator(builder.Build())
    simulator.AdvanceTo(1.5)
    set_parameters(formation, simulator.get_mutable_context(), other)
    simulator.AdvanceTo(2.0)
    np.testing.assert_allclose(state(simulator.get_context()), advanced(alone, 2.0, context), rtol=0, atol=1e-4)
    assert np.abs(state(simulator.get_context()) - advanced(build_diagram(scenario), 2.0)).max() > 1e-2


def test_clones_go_their_own_ways(scenario):
    diagram = build_diagram(scenario)
    simulator = Simulator(diagram)
    simulator.AdvanceTo(1.5)
    at_half = simulator.get_context().Clone()
    simulator.AdvanceTo(2.0)
    assert not np.array_equal(state(at_half), state(simulator.get_context()))
    np.testing.assert_allclose(advanced(diagram, 2.0, at_half), state(simulator.get_context()), rtol=0, atol=1e-4)
    np.testing.assert_array_equal(advanced(diagram.Clone(), 2.0), advanced(diagram, 2.0))


def test_log_vector_output_around_it(scenario):
    builder = DiagramBuilder()
    formation = builder.AddNamedSystem("formation", build_diagram(scenario))
    log = LogVectorOutput(formation.GetOutputPort("robot_1_state"), builder, 0.5)
    diagram = builder.Build()
    simulator = Simulator(diagram)
    simulator.AdvanceTo(2.0)
    samples = log.FindLog(simulator.get_context())
    assert samples.sample_times().tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    np.testing.assert_allclose(samples.data()[:, -1], advanced(build_diagram(scenario), 2.0)[:4], rtol=0, atol=1e-4)
