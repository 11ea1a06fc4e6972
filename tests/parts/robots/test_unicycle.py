import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.systems.analysis import ResetIntegratorFromFlags, Simulator
from scipy.integrate import solve_ivp

from drake_formation import ScenarioError, build_diagram, load_scenario, simulate
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.parameters import find_block
from drake_formation.parts.robots.point_mass import free_mass
from drake_formation.parts.robots.unicycle import Unicycle, linearizing_drive, unicycle_motion

SHORT = {"aggregation.duration": 0.5, "transport.duration": 2.5, "springs.stiffness": 30.0, "robots.mass": [30.0, 50.0]}
FIXED = {"simulator.use_error_control": False, "simulator.max_step_size": 0.05}
UNICYCLE = {"robots.kind": "unicycle", "robots.heading": {"1": 100.0, "2": -30.0}, "robots.velocity": [0.5, -0.3]}
AHEAD = 0.3
pairs = st.tuples(st.floats(-1e2, 1e2), st.floats(-1e2, 1e2))
slow = st.tuples(st.floats(-2, 2), st.floats(-2, 2))


def moved(part, heading, velocity, control, spring):
    numbers = (group.tolist() for group in part.own_numbers())
    return unicycle_motion([heading], velocity, control, spring, *numbers)


@given(st.floats(-10, 10), slow, pairs, pairs, st.floats(0.5, 20), st.floats(0.1, 1.0))
def test_linearized_the_held_point_is_accelerated_as_a_point_mass(heading, velocity, control, spring, inertia, ahead):
    part = Unicycle(Unicycle.Config(inertia=inertia, ahead=ahead))
    *found, _ = moved(part, heading, velocity, control, spring)
    assert found == pytest.approx(free_mass([], velocity, control, spring, [40.0]), abs=1e-10)


@given(st.floats(-10, 10), slow)
def test_it_turns_as_fast_as_its_held_point_moves_sideways(heading, velocity):
    *_, turning = moved(Unicycle(Unicycle.Config(ahead=AHEAD)), heading, velocity, (0.0, 0.0), (0.0, 0.0))
    along, across = (np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)]))
    axle = np.array(velocity) - AHEAD * turning * across
    assert axle @ across == pytest.approx(0.0, abs=1e-12)
    assert axle @ along == pytest.approx(velocity @ along, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_a_result_tells_the_heading_to_which_it_turned(engine):
    result = simulate(
        load_scenario("line", overrides={**SHORT, **UNICYCLE, "simulator.max_step_size": 0.01}), engine=engine
    )
    heading, (vx, vy) = result.heading.values, np.moveaxis(result.velocity.values, -1, 0)
    turning = (np.cos(heading) * vy - np.sin(heading) * vx) / AHEAD
    steps = np.diff(result.time.values)[:, None]
    turned = np.cumsum(0.5 * steps * (turning[1:] + turning[:-1]), axis=0)
    np.testing.assert_allclose(heading[0], np.radians([100.0, -30.0]))
    np.testing.assert_allclose(heading[1:], heading[0] + turned, atol=1e-3)
    assert np.ptp(heading) > 0.5


@given(st.floats(-10, 10), slow, pairs)
def test_limited_wheels_lose_no_energy_to_the_constraint(heading, velocity, spring):
    """With wheels of next to no force, only the object changes the kinetic energy of the body."""
    part = Unicycle(Unicycle.Config(ahead=AHEAD, inertia=3.0, wheel_force_limit=1e-12))
    ax, ay, turning = moved(part, heading, velocity, (50.0, 60.0), spring)
    c, s = np.cos(heading), np.sin(heading)
    forward = c * velocity[0] + s * velocity[1]
    # Of what the held point's acceleration is made: v̇ − L ω² along the heading, v ω + L ω̇ across it.
    speeding = c * ax + s * ay + AHEAD * turning**2
    twisting = (c * ay - s * ax - forward * turning) / AHEAD
    power = 40.0 * forward * speeding + 3.0 * turning * twisting
    assert power == pytest.approx(np.dot(spring, velocity), abs=1e-8)


def test_it_moves_as_the_textbooks_axle_speed_and_turning_rate_do():
    """The same robot in the coordinates of its axle, ẋ = v cos θ, ẏ = v sin θ, with wheels too weak to linearize it."""
    part = Unicycle(Unicycle.Config(ahead=AHEAD, inertia=3.0, track=0.6, wheel_force_limit=8.0))
    groups = [group.tolist() for group in part.own_numbers()]

    def push(t):
        return 40.0 * np.cos(t), 30.0 * np.sin(2 * t)

    def held(t, state):
        _, _, vx, vy, heading = state
        return vx, vy, *unicycle_motion([heading], (vx, vy), push(t), (0.0, 0.0), *groups)

    def axle(t, state):
        _, _, heading, forward, turning = state
        c, s = np.cos(heading), np.sin(heading)
        ux, uy = push(t)
        drive, torque = linearizing_drive(forward, turning, (c * ux + s * uy, c * uy - s * ux), (0.0, 0.0), groups[0])
        right, left = np.clip([drive / 2 + torque / 0.6, drive / 2 - torque / 0.6], -8.0, 8.0)
        return c * forward, s * forward, turning, (right + left) / 40.0, 0.3 * (right - left) / 3.0

    options = {"rtol": 1e-10, "atol": 1e-12, "max_step": 0.01}
    x, y, _, _, heading = solve_ivp(held, (0.0, 3.0), [AHEAD, 0.0, 0.2, 0.06, 0.0], **options).y[:, -1]
    cx, cy, turned, _, _ = solve_ivp(axle, (0.0, 3.0), [0.0, 0.0, 0.0, 0.2, 0.06 / AHEAD], **options).y[:, -1]
    assert abs(turned) > 0.1
    expected = cx + AHEAD * np.cos(turned), cy + AHEAD * np.sin(turned), turned
    assert (x, y, heading) == pytest.approx(expected, abs=1e-6)


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_the_held_points_move_as_point_masses_do(engine):
    found = simulate(load_scenario("line", overrides=SHORT | FIXED | UNICYCLE), engine=engine)
    free = {"robots.velocity": [0.5, -0.3]}
    expected = simulate(load_scenario("line", overrides=SHORT | FIXED | free), engine="blocks")
    for name in ("position", "velocity", "acceleration", "control_force"):
        at = [run[name].sel(time=[0.0, 0.5, 1.5, 3.0], method="nearest") for run in (found, expected)]
        np.testing.assert_allclose(*at, rtol=0, atol=1e-9)


def test_the_axle_never_moves_sideways_along_a_run():
    smooth = SHORT | UNICYCLE | {"aggregation.duration": 0.0, "avoidance.obstacles": []}
    diagram = build_diagram(load_scenario("line", overrides=smooth))
    simulator = Simulator(diagram)
    ResetIntegratorFromFlags(simulator, "runge_kutta5", 0.01)
    simulator.get_mutable_integrator().set_target_accuracy(1e-10)
    plant = find_block(diagram, "robot_1/plant").GetMyContextFromRoot(simulator.get_context())
    states, step = [], 0.005
    for k in range(500):
        simulator.AdvanceTo(step * k)
        states.append(plant.get_continuous_state_vector().CopyToVector())
    x, y, _, _, heading = np.transpose(states)
    axle = np.stack([x - AHEAD * np.cos(heading), y - AHEAD * np.sin(heading)])
    vx, vy = (8 * (axle[:, 3:-1] - axle[:, 1:-3]) - (axle[:, 4:] - axle[:, :-4])) / (12 * step)
    heading = heading[2:-2]
    sideways, forward = np.cos(heading) * vy - np.sin(heading) * vx, np.cos(heading) * vx + np.sin(heading) * vy
    assert np.ptp(heading) > 1.0  # it does turn
    assert np.ptp(forward) > 0.5
    assert np.abs(sideways).max() < 1e-5


def test_the_heading_falls_in_behind_the_way():
    overrides = UNICYCLE | {"robots.velocity": [0.0, 0.0], "aggregation.duration": 0.0, "avoidance.obstacles": []}
    diagram = build_diagram(load_scenario("line", overrides=overrides | {"transport.goal": [60.0, 3.5]}))
    simulator = Simulator(diagram)
    simulator.AdvanceTo(15.0)
    for robot in (1, 2):
        plant = find_block(diagram, f"robot_{robot}/plant").GetMyContextFromRoot(simulator.get_context())
        _, _, vx, vy, heading = plant.get_continuous_state_vector().CopyToVector()
        assert np.cos(heading - np.arctan2(vy, vx)) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_with_limited_wheels_the_recorded_acceleration_is_that_of_the_motion(engine):
    overrides = SHORT | FIXED | UNICYCLE | {"robots.wheel_force_limit": 5.0, "aggregation.duration": 0.0}
    result = simulate(load_scenario("line", overrides=overrides), engine=engine)
    gained = result["velocity"].values[-1] - result["velocity"].values[0]
    forces = result["control_force"] + result["spring_force"]
    np.testing.assert_allclose(result["acceleration"].integrate("time"), gained, atol=1e-2)
    assert np.abs(forces.integrate("time") / [[30.0], [50.0]] - gained).max() > 0.1


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"robots.ahead": 0.0}, r"robots.ahead: out of range .*it could not be moved sideways"),
        ({"robots.ahead": {"1": -0.1}}, r"robots.ahead.1: out of range"),
        ({"robots.track": 0.0}, r"robots.track: out of range"),
        ({"robots.wheel_force_limit": 0.0}, r"robots.wheel_force_limit: out of range"),
    ],
)
def test_bad_robots_are_refused_with_the_reason(change, fault):
    with pytest.raises(ScenarioError, match=fault):
        load_scenario("line", overrides={"robots.kind": "unicycle"} | change)


def test_it_is_not_certified():
    with pytest.raises(IllPosedError, match="robot 1 is a 'unicycle'"):
        linearize(load_scenario("line", overrides={"robots.kind": "unicycle"}))
