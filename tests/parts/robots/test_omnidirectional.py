import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydrake.systems.analysis import Simulator

from drake_formation import ScenarioError, build_diagram, load_scenario, simulate
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.parameters import find_block
from drake_formation.parts.robots.omnidirectional import Omnidirectional, heading_gain, omnidirectional_motion
from drake_formation.parts.robots.point_mass import free_mass

SHORT = {"aggregation.duration": 0.5, "transport.duration": 1.5, "springs.stiffness": 30.0, "robots.mass": [30.0, 50.0]}
FIXED = {"simulator.use_error_control": False, "simulator.max_step_size": 0.05}
OMNI = {"robots.kind": "omnidirectional", "robots.heading": 70.0, "robots.kept_heading": 10.0}
MECANUM = {"robots.wheel_angles": [45, 135, 225, 315], "robots.push_angles": [-45, 45, -45, 45]}
pairs = st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3))


def moved(part, inner, control, spring, velocity=(0.0, 0.0)):
    return omnidirectional_motion(inner, velocity, control, spring, *(group.tolist() for group in part.own_numbers()))


@given(st.floats(-10, 10), pairs, pairs)
def test_the_centre_is_accelerated_as_a_point_mass_whatever_the_heading(heading, control, spring):
    ax, ay, rate, _ = moved(Omnidirectional(Omnidirectional.Config()), [heading, 0.7], control, spring)
    expected = free_mass([], (0.0, 0.0), control, spring, [40.0])
    assert (ax, ay) == pytest.approx(expected, abs=1e-11)
    assert rate == 0.7


@given(st.floats(0.1, 10), st.floats(0.1, 100), st.floats(0, 100), st.floats(0.01, 10))
def test_the_headings_gain_is_the_double_integrators(inertia, angle_cost, rate_cost, torque_cost):
    k = np.sqrt(angle_cost / torque_cost)
    expected = k, np.sqrt(rate_cost / torque_cost + 2 * inertia * k)
    assert heading_gain(inertia, (angle_cost, rate_cost), torque_cost) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
@pytest.mark.parametrize("wheels", [{}, MECANUM], ids=["omni", "mecanum"])
def test_with_unlimited_wheels_the_positions_are_the_point_masss(engine, wheels):
    found = simulate(load_scenario("line", overrides=SHORT | FIXED | OMNI | wheels), engine=engine)
    expected = simulate(load_scenario("line", overrides=SHORT | FIXED), engine="blocks")
    for name in ("position", "velocity", "acceleration", "control_force", "deviation"):
        np.testing.assert_allclose(found[name], expected[name], rtol=0, atol=1e-9)


def test_the_exponential_engine_carries_the_heading_along():
    scenario = load_scenario("line", overrides=SHORT | OMNI | {"simulator.accuracy": 1e-8})
    found, expected = (simulate(scenario, engine=engine)["position"].values[-1] for engine in ("exponential", "blocks"))
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-5)


def test_the_heading_comes_to_that_to_keep_the_short_way():
    overrides = {"robots.kind": "omnidirectional", "robots.heading": 350.0, "robots.kept_heading": 5.0}
    diagram = build_diagram(load_scenario("line", overrides=overrides | {"aggregation.duration": 0.0}))
    simulator = Simulator(diagram)
    plant = find_block(diagram, "robot_1/plant").GetMyContextFromRoot(simulator.get_context())
    inner = lambda: plant.get_continuous_state_vector().CopyToVector()[4:]  # noqa: E731
    assert np.degrees(inner()) == pytest.approx([-10.0, 0.0])
    simulator.AdvanceTo(15.0)
    assert np.degrees(inner()) == pytest.approx([5.0, 0.0], abs=0.05)


def test_limited_wheels_do_what_they_can():
    part = Omnidirectional(Omnidirectional.Config(wheel_force_limit=10.0, mass=1.0))
    # The first of three wheels stands ahead and pushes sideways alone; the others must push the rest.
    ax, ay, _, _ = moved(part, [0.0, 0.0], (1e6, 0.0), (0.0, 0.0))
    assert (ax, ay) == pytest.approx((2 * 10.0 * np.sqrt(3) / 2, 0.0), abs=1e-6)
    free = Omnidirectional(Omnidirectional.Config(mass=1.0))
    small = [0.3, 0.1], (3.0, -2.0), (1.0, 4.0)
    assert moved(part, *small) == moved(free, *small)


def test_wheels_at_their_largest_speed_drive_no_further_but_brake():
    part = Omnidirectional(Omnidirectional.Config(wheel_force_limit=10.0, wheel_speed_limit=2.0, mass=1.0))
    # Along the heading the first of three wheels stands still; the others run at sin 60 deg of the robot's speed.
    share = np.sqrt(3) / 2
    for speed, driven in ((0.0, 20.0), (1.0 / share, 10.0), (2.0 / share, 0.0)):
        assert moved(part, [0.0, 0.0], (1e6, 0.0), (0.0, 0.0), (speed, 0.0))[0] == pytest.approx(driven * share)
        assert moved(part, [0.0, 0.0], (-1e6, 0.0), (0.0, 0.0), (speed, 0.0))[0] == pytest.approx(-20.0 * share)


def test_a_robot_gathers_the_speed_that_its_wheels_allow():
    """One robot that is called far away: m v̇ = F (1 − v/v₀) for two wheels, by their torque-speed line."""
    limits = {"robots.wheel_force_limit": 10.0, "robots.wheel_speed_limit": 2.0}
    far = {"robots.start": [[0.0, 0.0]], "transport": {"goal": [900.0, 0.0], "duration": 8.0}}
    one = {"formation": {"shape": "line", "robots": 1, "side": 1.0}, "robots.kind": "omnidirectional"}
    start = {"aggregation.duration": 0.0, "avoidance": {"obstacles": []}, "robots.heading": 0.0}
    result = simulate(load_scenario("line", overrides=one | far | start | limits))
    force, fastest = 2 * 10.0 * np.sqrt(3) / 2, 2.0 / (np.sqrt(3) / 2)
    expected = fastest * (1 - np.exp(-force / (40.0 * fastest) * result["time"].values))
    np.testing.assert_allclose(result["velocity"].values[:, 0, 0], expected, atol=1e-5)


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_with_limited_wheels_the_recorded_acceleration_is_that_of_the_motion(engine):
    overrides = SHORT | FIXED | OMNI | {"robots.wheel_force_limit": 2.0, "aggregation.duration": 0.0}
    result = simulate(load_scenario("line", overrides=overrides), engine=engine)
    gained = result["velocity"].values[-1] - result["velocity"].values[0]
    forces = result["control_force"] + result["spring_force"]
    np.testing.assert_allclose(result["acceleration"].integrate("time"), gained, atol=1e-2)
    assert np.abs(forces.integrate("time") / [[30.0], [50.0]] - gained).max() > 0.1


def test_a_formation_may_have_robots_of_several_kinds():
    mixed = {"robots.kind": ["omnidirectional", "point_mass"], "robots.heading": {"1": 30.0}}
    moving = SHORT | FIXED | {"robots.velocity": {"2": [0.3, -0.2]}}
    found, expected = (simulate(load_scenario("line", overrides=moving | kinds)) for kinds in (mixed, {}))
    np.testing.assert_allclose(found["position"], expected["position"], rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        ({"robots.wheel_angles": [0, 90]}, r"robots.wheel_angles: 2 wheels .*three or four"),
        ({"robots.push_angles": [0, 90]}, r"robots.push_angles: 2 directions for 3 wheels"),
        ({"robots.push_angles": [0, 0, 0]}, r"robots.push_angles: .*rank 2, not 3: they cannot push along 90 deg"),
        ({"robots.wheel_angles": [0, 0, 120]}, r"robots.wheel_angles: .*rank 2, not 3"),
        ({"robots.wheel_angles": {"2": [0, 0, 120]}}, r"robots.wheel_angles.2: .*rank 2, not 3"),
        ({"robots.wheel_distance": 0.0}, r"robots.wheel_distance: out of range"),
        ({"robots.inertia": 1e-300}, r"robots.heading_cost: Drake finds no gain"),
        ({"robots.wheel_speed_limit": 2.0}, r"robots.wheel_speed_limit: .* also wheel_force_limit"),
        ({"robots.drag": 1.0}, r"robots.drag: unknown key"),
    ],
)
def test_bad_robots_are_refused_with_the_reason(change, fault):
    with pytest.raises(ScenarioError, match=fault):
        load_scenario("line", overrides={"robots.kind": "omnidirectional"} | change)


def test_it_is_not_certified():
    with pytest.raises(IllPosedError, match="robot 1 is a 'omnidirectional'"):
        linearize(load_scenario("line", overrides={"robots.kind": "omnidirectional"}))
