import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from strategies import gains, metres, speeds

from drake_formation import ScenarioError, build_diagram, load_scenario, simulate
from drake_formation.analysis import IllPosedError, linearize, start_force
from drake_formation.parts import kinds
from drake_formation.parts.robots.plant import PlanarRobot
from drake_formation.parts.robots.point_mass import RobotPlant, dragged_mass, free_mass
from drake_formation.parts.springs.hookean import hookean_spring_force
from drake_formation.parts.springs.linear import Linear, linear_spring_force
from drake_formation.scenario import with_overrides
from drake_formation.simulation.motion import Motion
from drake_formation.simulation.result import series_of

laws = pytest.mark.parametrize("law", [part.law for part in kinds("spring").values()], ids=kinds("spring"))
relative = st.tuples(metres, metres, speeds, speeds).filter(lambda x: np.hypot(x[0], x[1]) > 0.1)
displacements = st.tuples(metres, metres).filter(lambda h: np.hypot(*h) > 0.1)


@laws
@given(x=relative, k=gains, c=gains, h=displacements)
def test_springs_pull_both_ends_alike(law, x, k, c, h):
    one = law(*x, k, c, *h)
    other = law(*np.negative(x).tolist(), k, c, *np.negative(h).tolist())
    assert one == tuple(-f for f in other)


@laws
@given(k=gains, c=gains, h=displacements)
def test_springs_rest_at_the_slot_displacement(law, k, c, h):
    assert law(*h, 0.0, 0.0, k, c, *h) == pytest.approx((0.0, 0.0), abs=1e-11)


@given(relative, gains, gains, displacements)
def test_a_hookean_spring_exerts_no_torque(x, k, c, h):
    dx, dy, *_ = x
    fx, fy = hookean_spring_force(*x, k, c, *h)
    assert dx * fy - dy * fx == pytest.approx(0, abs=1e-12 * (1 + np.hypot(fx, fy)) * 10)


@given(displacements, st.floats(-np.pi, np.pi), gains)
def test_a_hookean_spring_lets_its_pair_rotate(h, angle, k):
    dx, dy = rotated(h, angle)
    assert hookean_spring_force(dx, dy, 0.0, 0.0, k, 0.0, *h) == pytest.approx((0, 0), abs=1e-9)


@given(displacements, st.floats(0.1, 3.0), st.floats(1, 1e4))
def test_a_linear_spring_turns_its_pair_back(h, angle, k):
    dx, dy = rotated(h, angle)
    fx, fy = linear_spring_force(dx, dy, 0.0, 0.0, k, 0.0, *h)
    # Robot i feels −F: the torque on the pair is against the rotation.
    assert -(dx * fy - dy * fx) == pytest.approx(-k * np.dot(h, h) * np.sin(angle), rel=1e-9)


@given(displacements, st.floats(-0.5, 1.0), gains)
def test_both_laws_agree_along_the_line(h, stretch, k):
    dx, dy = (1 + stretch) * np.array(h)
    along = float(dx), float(dy), 0.0, 0.0
    expected = k * stretch * np.array(h)
    assert hookean_spring_force(*along, k, 0.0, *h) == pytest.approx(expected, abs=1e-8)
    assert linear_spring_force(*along, k, 0.0, *h) == pytest.approx(expected, abs=1e-8)


@given(relative, gains, displacements)
def test_hookean_force_is_equation_2(x, k, h):
    dx, dy, *_ = x
    factor = k * (1 - np.hypot(*h) / np.hypot(dx, dy))
    assert hookean_spring_force(*x, k, 0.0, *h) == pytest.approx((factor * dx, factor * dy), rel=1e-9, abs=1e-8)


@laws
@given(x=relative, c=gains, h=displacements)
def test_damping_takes_energy_away(law, x, c, h):
    _, _, dvx, dvy = x
    fx, fy = law(*x, 0.0, c, *h)
    assert fx * dvx + fy * dvy >= 0


@given(relative, gains, displacements)
def test_a_hookean_damper_resists_the_rate_of_the_length(x, c, h):
    dx, dy, dvx, dvy = x
    length, step = np.hypot(dx, dy), 1e-6
    rate = (np.hypot(dx + step * dvx, dy + step * dvy) - np.hypot(dx - step * dvx, dy - step * dvy)) / (2 * step)
    expected = c * rate * np.array([dx, dy]) / length
    assert hookean_spring_force(*x, 0.0, c, *h) == pytest.approx(expected, rel=1e-6, abs=1e-8 * c + 1e-9)


@given(relative, st.floats(1, 1e4), displacements)
def test_a_hookean_damper_acts_on_the_change_of_length_alone(x, c, h):
    dx, dy, *_ = x
    across = -dy, dx
    assert hookean_spring_force(dx, dy, *across, 0.0, c, *h) == pytest.approx((0, 0), abs=1e-9)


def rotated(vector, angle):
    x, y = vector
    return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)


@pytest.fixture
def plant():
    return RobotPlant([2], Linear, [40.0], [[10.0, 0.0, 0.0, -1.0]], [1.0, 2.0, 3.0, 4.0])


@pytest.mark.parametrize("phase", [0.0, 1.0])
def test_the_plant_obeys_newton(plant, phase):
    context = plant.CreateDefaultContext()
    plant.GetInputPort("force").FixValue(context, [4.0, -8.0])
    plant.GetInputPort("phase").FixValue(context, [phase])
    plant.GetInputPort("spring_2").FixValue(context, [1.5, 2.0, 0.0, 0.0])
    # Robot 1 is 0.5 m left of robot 2 and 1 m above its slot displacement.
    spring = phase * np.array([5.0, -10.0])
    np.testing.assert_allclose(plant.GetOutputPort("spring_force").Eval(context), spring)
    derivatives = plant.EvalTimeDerivatives(context).CopyToVector()
    np.testing.assert_allclose(derivatives, [3.0, 4.0, *((np.array([4.0, -8.0]) + spring) / 40)])


def test_the_plant_starts_at_its_initial_state(plant):
    context = plant.CreateDefaultContext()
    assert plant.GetOutputPort("state").Eval(context).tolist() == [1.0, 2.0, 3.0, 4.0]


def test_the_plants_state_splits_into_positions_and_velocities(plant):
    state = plant.CreateDefaultContext().get_continuous_state()
    assert state.get_generalized_position().CopyToVector().tolist() == [1.0, 2.0]
    assert state.get_generalized_velocity().CopyToVector().tolist() == [3.0, 4.0]


SHORT = {"aggregation.duration": 0.5, "transport.duration": 1.5, "springs.stiffness": 30.0, "avoidance.obstacles": []}
DRAGGED = SHORT | {"robots.drag": {"1": 50.0}, "robots.velocity": {"1": [1.0, -2.0]}}
FIXED = {"simulator.use_error_control": False, "simulator.max_step_size": 0.1}


@given(relative, gains, st.floats(1.0, 100.0))
def test_without_drag_a_mass_is_free(x, force, mass):
    *velocity, fx, fy = x
    control, spring = (fx, force), (fy, -force)
    assert dragged_mass([], velocity, control, spring, [mass], [0.0]) == free_mass(
        [], velocity, control, spring, [mass]
    )


def test_drag_lets_a_coasting_mass_fall_off_exponentially():
    plant = PlanarRobot(dragged_mass, [], Linear, [[40.0], [20.0]], np.zeros((0, 4)), [0.0, 0.0, 3.0, -1.0])
    simulator = Simulator(plant)
    context = simulator.get_mutable_context()
    plant.GetInputPort("force").FixValue(context, [0.0, 0.0])
    plant.GetInputPort("phase").FixValue(context, [0.0])
    ResetIntegratorFromFlags(simulator, "runge_kutta5", 0.1)
    simulator.get_mutable_integrator().set_target_accuracy(1e-10)
    simulator.AdvanceTo(4.0)
    start, left = np.array([3.0, -1.0]), np.exp(-20.0 / 40.0 * 4.0)
    expected = [*(start * (1 - left) * 40.0 / 20.0), *(start * left)]
    np.testing.assert_allclose(plant.GetOutputPort("state").Eval(context), expected, atol=1e-8)


def test_a_part_without_drag_tells_no_acceleration():
    diagram = build_diagram(load_scenario("line", overrides=DRAGGED))
    assert [diagram.HasOutputPort(f"robot_{i}_acceleration") for i in (1, 2)] == [True, False]


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_the_recorded_acceleration_counts_the_drag(engine):
    result = simulate(load_scenario("line", overrides=DRAGGED), engine=engine)
    velocity, forces = result["velocity"].values, (result["control_force"] + result["spring_force"]).values
    dragged, free = ((forces - [[50.0], [0.0]] * velocity) / 40.0).swapaxes(0, 1)
    np.testing.assert_allclose(result["acceleration"].values[:, 0], dragged, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(result["acceleration"].values[:, 1], free, rtol=1e-12, atol=1e-12)


def test_a_run_with_drag_is_known_between_its_samples():
    scenario = load_scenario("line", overrides=DRAGGED | FIXED | {"aggregation.duration": 0.0})
    coarse, fine = (
        series_of(simulate(with_overrides(scenario, {"simulator.max_step_size": step}), engine="blocks"))
        for step in (0.1, 0.05)
    )
    between = np.isclose(coarse["time"][:-1, None] + 0.05, fine["time"]).any(axis=0)
    motion = Motion(*(coarse[name] for name in ("time", "position", "velocity", "acceleration")))
    position, velocity, acceleration = motion.at_times(fine["time"][between])
    assert between.sum() == 15
    np.testing.assert_allclose(position, fine["position"][between], atol=1e-6)
    np.testing.assert_allclose(velocity, fine["velocity"][between], atol=1e-5)
    np.testing.assert_allclose(acceleration, fine["acceleration"][between], atol=1e-3)


def test_blocks_and_compiled_code_agree_on_drag_and_velocity():
    scenario = load_scenario("line", overrides=DRAGGED | FIXED)
    found, expected = (simulate(scenario, engine=engine) for engine in ("compiled", "blocks"))
    for name in ("position", "velocity", "acceleration"):
        np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("written", "expected"),
    [([1.0, 2.0], [[1, 2], [1, 2]]), ({"2": [3, 4]}, [[0, 0], [3, 4]]), (None, [[0, 0], [0, 0]])],
)
def test_robots_start_with_the_velocity_they_are_given(written, expected):
    changes = {} if written is None else {"robots.velocity": written}
    result = simulate(load_scenario("line", overrides=SHORT | changes), engine="blocks")
    assert result["velocity"].values[0].tolist() == expected


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"robots.drag": -1.0}, "robots.drag: out of range"),
        ({"robots.velocity": [1.0]}, "robots.velocity"),
        ({"robots.velocity": {"3": [1.0, 0.0]}}, "robots.velocity.3: there is no robot 3"),
    ],
)
def test_bad_drag_and_velocity_are_refused(change, fault):
    with pytest.raises(ScenarioError, match=fault):
        load_scenario("line", overrides=change)


def test_what_is_certified_is_a_mass_without_drag():
    with pytest.raises(IllPosedError, match="robot 2 has a drag"):
        linearize(load_scenario("line", overrides={"robots.drag": {"2": 1.0}}))


def test_what_is_certified_does_not_depend_on_velocities_at_the_start():
    moving = linearize(load_scenario("line", overrides={"robots.velocity": [1.0, 0.5]}))
    np.testing.assert_array_equal(moving.A, linearize(load_scenario("line")).A)


def test_the_force_that_a_start_takes_is_certified_from_rest_alone():
    with pytest.raises(IllPosedError, match="robot 1 starts with a velocity"):
        start_force(load_scenario("line", overrides={"robots.velocity": {"1": [0.1, 0.0]}, "consensus.delta": 100.0}))
