import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from probe import context_at, derivatives, parameters, robot_outputs, state_of
from pydrake.autodiffutils import AutoDiffXd, ExtractGradient, ExtractValue, InitializeAutoDiff
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import InputPortSelection, OutputPortSelection
from pydrake.systems.primitives import Linearize
from strategies import generators, metres, random_state, scenarios

from drake_formation.diagram import build_diagram
from drake_formation.formation import graphs
from drake_formation.parts.avoidance.khatib import avoidance_force
from drake_formation.parts.tracking.costs import cost_matrix
from drake_formation.parts.tracking.lqr import lqr_gain, robot_matrices
from drake_formation.robot_diagram import ROBOT_OUTPUTS
from drake_formation.scenario import ScenarioError, load_scenario, resolve, with_overrides

few = settings(max_examples=25)
angles = st.floats(-np.pi, np.pi)

FORCES = ("tracking_force", "consensus_force", "avoidance_force", "control_force", "spring_force")


def forces(scenario, state):
    """Every force port of every robot in a state, by name."""
    diagram = build_diagram(scenario)
    context = context_at(diagram, state)
    return {name: robot_outputs(diagram, context, name) for name in FORCES}


# What the robots do to each other


@few
@given(scenarios(), generators)
def test_consensus_and_springs_conserve_momentum(scenario, rng):
    result = forces(scenario, random_state(scenario, rng))
    np.testing.assert_allclose(result["consensus_force"].sum(axis=0), 0, atol=1e-9)
    np.testing.assert_allclose(result["spring_force"].sum(axis=0), 0, atol=1e-9)


@settings(max_examples=8)
@given(scenarios(obstacles=st.just(0)), generators)
def test_springs_conserve_energy_when_nothing_else_acts(scenario, rng):
    scenario = with_overrides(scenario, {"springs.damping": 0.0, "consensus.delta": 0.0, "consensus.delta_v": 0.0})
    diagram = build_diagram(scenario)
    context = context_at(diagram, random_state(scenario, rng))
    for i in range(len(resolve(scenario).slots)):
        tracking = diagram.GetSubsystemByName(f"robot_{i + 1}").GetSubsystemByName("tracking")
        tracking.GetMyMutableContextFromRoot(context).get_mutable_numeric_parameter(0).SetFromVector(np.zeros(8))
    before = energy(scenario, state_of(context))
    simulator = Simulator(diagram, context)
    simulator.get_mutable_integrator().set_target_accuracy(1e-8)
    simulator.AdvanceTo(0.5)
    assert energy(scenario, state_of(context)) == pytest.approx(before, rel=1e-6, abs=1e-9)


def energy(scenario, state):
    """Kinetic energy and what the springs hold (J)."""
    slots, (positions, velocities) = resolve(scenario).slots, np.split(state, 2, axis=1)
    total = (resolve(scenario).masses * (velocities**2).sum(axis=1)).sum() / 2
    edges = [tuple(pair) for pair in resolve(scenario).springs.pairs.tolist()]
    for (i, j), k in zip(edges, resolve(scenario).field("spring", "stiffness"), strict=True):
        apart, rest = positions[i] - positions[j], slots[i] - slots[j]
        if scenario.springs.law == "hookean":
            total += k / 2 * (np.linalg.norm(apart) - np.linalg.norm(rest)) ** 2
        else:
            total += k / 2 * ((apart - rest) ** 2).sum()
    return total


# Where the world frame stands


@few
@given(scenarios(), generators, metres, metres)
def test_forces_do_not_depend_on_where_the_world_frame_stands(scenario, rng, x, y):
    state, shift = random_state(scenario, rng), np.array([x, y])
    moved = forces(transformed(scenario, lambda points: points + shift), np.add(state, [x, y, 0, 0]))
    for name, force in forces(scenario, state).items():
        np.testing.assert_allclose(moved[name], force, rtol=1e-7, atol=1e-7, err_msg=name)


@few
@given(scenarios(isotropic=True), generators, angles)
def test_forces_turn_with_the_world_frame(scenario, rng, angle):
    state = random_state(scenario, rng)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    turned_scenario = transformed(scenario, lambda points: points @ turn.T, slots=resolve(scenario).slots @ turn.T)
    turned = forces(turned_scenario, (state.reshape(-1, 2, 2) @ turn.T).reshape(-1, 4))
    for name, force in forces(scenario, state).items():
        np.testing.assert_allclose(turned[name], force @ turn.T, rtol=1e-7, atol=1e-7, err_msg=name)


def transformed(scenario, transform, slots=None):
    """The scenario with every point of the world, and the slots if given, elsewhere."""
    changes = {
        "robots.start": transform(resolve(scenario).starts),
        "transport.goal": transform(np.array(scenario.transport.goal)),
    }
    for k, obstacle in enumerate(scenario.avoidance.obstacles):
        changes[f"avoidance.obstacles.{k}.position"] = transform(np.array(obstacle.position))
    if slots is not None:
        changes["formation"] = {"shape": "slots", "slots": slots.tolist()}
    return with_overrides(scenario, changes)


# The closed loop


def gain_of(scenario, mass):
    lqr = resolve(scenario).parts["tracking"][0]
    return lqr_gain(mass, lqr.state_cost, lqr.input_cost)


def linearized(scenario):
    """The diagram linearized about the formation at the goal."""
    diagram = build_diagram(scenario)
    arrived = np.array(scenario.transport.goal) + resolve(scenario).slots
    context = context_at(diagram, np.hstack([arrived, np.zeros_like(arrived)]))
    return Linearize(diagram, context, InputPortSelection.kNoInput, OutputPortSelection.kNoOutput).A()


linear_springs = {"law": st.just("linear"), "obstacles": st.just(0)}


@few
@given(scenarios(homogeneous=True, **linear_springs))
def test_the_linearized_diagram_is_the_papers_closed_loop(scenario):
    """I ⊗ (A − B K) − L_k ⊗ Z − L_g ⊗ B Δ (paper, Eqs. 6, 7, 10 and 17), for springs without damping."""
    scenario = with_overrides(scenario, {"springs.damping": 0.0})
    mass, stiffness = scenario.robots.mass, scenario.springs.stiffness
    a, b = robot_matrices(mass)
    z = np.zeros((4, 4))
    z[2:, :2] = stiffness / mass * np.eye(2)
    delta = np.kron([scenario.consensus.delta, scenario.consensus.delta_v], np.eye(2))
    physical, channels = (
        graphs.laplacian(graph) for graph in (resolve(scenario).springs.graph, resolve(scenario).channels.graph)
    )
    local = np.kron(
        np.eye(len(physical)),
        a - b @ gain_of(scenario, mass),
    )
    expected = local - np.kron(physical, z) - np.kron(channels, b @ delta)
    np.testing.assert_allclose(linearized(scenario), expected, rtol=1e-9, atol=1e-9)


@few
@given(scenarios(**linear_springs))
def test_the_linearized_diagram_holds_every_robots_mass_and_every_edges_spring(scenario):
    masses, edges = resolve(scenario).masses, [tuple(pair) for pair in resolve(scenario).springs.pairs.tolist()]
    delta = np.kron([scenario.consensus.delta, scenario.consensus.delta_v], np.eye(2))
    couplings = np.kron(resolve(scenario).channels.laplacian, delta)
    for name, gain in (("stiffness", [[1, 0, 0, 0], [0, 1, 0, 0]]), ("damping", [[0, 0, 1, 0], [0, 0, 0, 1]])):
        values = resolve(scenario).field("spring", name)
        couplings = couplings + np.kron(weighted_laplacian(len(masses), edges, values), gain)
    expected = np.zeros((4 * len(masses),) * 2)
    for i, mass in enumerate(masses):
        a, b = robot_matrices(mass)
        rows = slice(4 * i, 4 * i + 4)
        expected[rows, rows] += a - b @ lqr_gain(
            mass, cost_matrix(scenario.tracking.Q, 4), cost_matrix(scenario.tracking.R, 2)
        )
        expected[rows] -= b @ couplings[2 * i : 2 * i + 2]
    np.testing.assert_allclose(linearized(scenario), expected, rtol=1e-9, atol=1e-9)


def weighted_laplacian(nodes, edges, weights):
    incidence = np.zeros((nodes, len(edges)))
    for column, (i, j) in enumerate(edges):
        incidence[[i, j], column] = 1, -1
    return incidence @ np.diag(weights) @ incidence.T


@few
@given(scenarios(obstacles=st.integers(1, 3)), generators)
def test_automatic_gradients_are_the_slopes_of_the_closed_loop(scenario, rng):
    state = random_state(scenario, rng)
    assume(not near_switching(scenario, state))
    diagram = build_diagram(scenario)
    differentiable = diagram.ToAutoDiffXd()
    context = differentiable.CreateDefaultContext()
    context.SetContinuousState(InitializeAutoDiff(state.ravel()).ravel())
    gradient = ExtractGradient(derivatives(differentiable, context).reshape(-1, 1))

    def at(point):
        return derivatives(diagram, context_at(diagram, point))

    steps = 1e-6 * np.eye(state.size)
    slopes = np.array([at(state.ravel() + step) - at(state.ravel() - step) for step in steps]).T / 2e-6
    np.testing.assert_allclose(gradient, slopes, rtol=1e-5, atol=1e-5)


def near_switching(scenario, state, margin=1e-3):
    """Whether a robot is about to enter an obstacle's range, or to become the nearest to it."""
    for obstacle in scenario.avoidance.obstacles:
        distances = np.linalg.norm(state[:, :2] - obstacle.position, axis=1)
        to_range = abs(distances - obstacle.radius - scenario.avoidance.range)
        between = np.diff(np.sort(distances))
        if min([*to_range, *between]) < margin:
            return True
    return False


@few
@given(scenarios(obstacles=st.integers(1, 3)), generators)
def test_each_robot_feels_the_obstacles_that_it_senses(scenario, rng):
    state, field = random_state(scenario, rng), scenario.avoidance
    expected = np.zeros((len(state), 2))
    for obstacle in field.obstacles:
        away = state[:, :2] - obstacle.position
        distances = np.linalg.norm(away, axis=1)
        for i, (dx, dy) in enumerate(away.tolist()):
            if field.sensing == "in_range" or distances[i] == distances.min():
                expected[i] += avoidance_force(dx, dy, obstacle.radius, field.range, field.gain)
    np.testing.assert_allclose(forces(scenario, state)["avoidance_force"], expected, rtol=1e-9, atol=1e-9)


@few
@given(scenarios(), generators)
def test_the_control_force_is_the_sum_of_its_three_parts(scenario, rng):
    result = forces(scenario, random_state(scenario, rng))
    parts = result["tracking_force"] + result["consensus_force"] + result["avoidance_force"]
    np.testing.assert_allclose(result["control_force"], parts, rtol=1e-12, atol=1e-9)


# The structure


@few
@given(scenarios())
def test_the_default_context_is_the_initial_state_at_rest(scenario):
    state = state_of(build_diagram(scenario).CreateDefaultContext())
    np.testing.assert_array_equal(state, np.hstack([resolve(scenario).starts, np.zeros((len(state), 2))]))


@pytest.mark.parametrize("sensing", ["in_range", "nearest"])
def test_no_output_of_a_robot_follows_a_neighbour_at_once_but_through_its_own_ports(sensing):
    robot = build_diagram(load_scenario("line", overrides={"avoidance.sensing": sensing})).GetSubsystemByName("robot_1")
    reached = {
        (robot.get_input_port(i).get_name(), robot.get_output_port(o).get_name())
        for i in range(robot.num_input_ports())
        for o in range(robot.num_output_ports())
        if robot.HasDirectFeedthrough(i, o)
    }
    expected = {
        ("phase", "spring_force"),
        ("spring_2", "spring_force"),
        ("reference", "tracking_error"),
        ("reference", "tracking_force"),
        ("channel_2", "consensus_force"),
        ("phase", "avoidance_force"),
        ("reference", "control_force"),
        ("channel_2", "control_force"),
        ("phase", "control_force"),
    }
    if sensing == "nearest":
        expected |= {("sensed", "avoidance_force"), ("sensed", "control_force")}
    assert reached == expected


@few
@given(scenarios())
def test_any_scenario_is_a_diagram_without_inputs_or_algebraic_loops(scenario):
    diagram = build_diagram(scenario)
    assert diagram.num_input_ports() == 0
    assert not diagram.HasAnyDirectFeedthrough()


def test_blocks_and_ports_have_readable_names():
    diagram = build_diagram(load_scenario("line", overrides={"avoidance.sensing": "nearest"}))
    blocks = {system.get_name() for system in diagram.GetSystems()}
    assert blocks == {"phase", "reference", "robot_1", "robot_2", "sensing", "consensus_error"}
    parts = {system.get_name() for system in diagram.GetSubsystemByName("robot_2").GetSystems()}
    assert parts == {"plant", "tracking", "consensus", "avoidance", "control"}
    ports = {diagram.get_output_port(k).get_name() for k in range(diagram.num_output_ports())}
    per_robot = {f"robot_{i}_{name}" for i in (1, 2) for name in (*ROBOT_OUTPUTS, "consensus_error")}
    assert ports == per_robot | {"phase"}


def test_an_unsound_scenario_is_refused():
    scenario = load_scenario("line")
    unsound = scenario.model_copy(update={"robots": scenario.robots.model_copy(update={"mass": (1.0, 2.0, 3.0)})})
    with pytest.raises(ScenarioError, match="3 values for 2 robots"):
        build_diagram(unsound)


# Other scalars


@pytest.mark.parametrize("convert", ["ToAutoDiffXd", "ToSymbolic"])
@settings(max_examples=10)
@given(scenario=scenarios())
def test_every_scalar_type_starts_at_the_same_state_with_the_same_numbers(convert, scenario):
    diagram = build_diagram(scenario)
    other = getattr(diagram, convert)()
    context, other_context = diagram.CreateDefaultContext(), other.CreateDefaultContext()
    for of in (lambda c: c.get_continuous_state_vector().CopyToVector(), parameters):
        np.testing.assert_array_equal(plain(of(other_context)), of(context))
    np.testing.assert_allclose(
        plain(derivatives(other, other_context)), derivatives(diagram, context), rtol=1e-12, atol=1e-12
    )


@pytest.mark.parametrize("convert", ["ToAutoDiffXd", "ToSymbolic"])
def test_every_scalar_type_starts_with_the_aggregation(convert):
    diagram = build_diagram(load_scenario("line"))
    other = getattr(diagram, convert)()
    context, other_context = diagram.CreateDefaultContext(), other.CreateDefaultContext()
    assert plain(other.GetOutputPort("phase").Eval(other_context)).tolist() == [0]
    np.testing.assert_allclose(
        plain(derivatives(other, other_context)), derivatives(diagram, context), rtol=1e-12, atol=1e-12
    )


def plain(values):
    """Numbers of any scalar type as floats."""
    if len(values) and isinstance(values[0], AutoDiffXd):
        return ExtractValue(values).ravel()
    return np.array([value if isinstance(value, float) else value.Evaluate() for value in values])


def test_a_changed_parameter_is_not_shared_with_other_contexts():
    diagram = build_diagram(load_scenario("line"))
    before = parameters(diagram.CreateDefaultContext())
    changed = diagram.CreateDefaultContext()
    plant = diagram.GetSubsystemByName("robot_1").GetSubsystemByName("plant")
    plant.GetMyMutableContextFromRoot(changed).get_mutable_numeric_parameter(0).SetFromVector([1.0])
    np.testing.assert_array_equal(parameters(diagram.CreateDefaultContext()), before)
    assert (parameters(changed) != before).sum() == 1
