"""Motors: limits, lag and dead zone by themselves, and what a formation of such robots does."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder
from pydrake.systems.primitives import ConstantVectorSource
from tracking_loops import START, alone, two

from drake_formation import ScenarioError, build_diagram, simulate, with_overrides
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.measuring import metrics
from drake_formation.parts.actuators.motor import FEATURES, Motor, exerted_at_once

MASS = 40.0
components = st.floats(-50, 50)
forces, limits = st.tuples(components, components), st.floats(0.01, 30)
NOT_LIMITING = 1e9


def limited(scenario, **motor):
    """The scenario with motors as actuators."""
    return with_overrides(scenario, {"actuator": {"kind": "motor", **motor}})


def response(demanded, times, **motor):
    """The force of motors at some times (s) that are asked for a constant one from 0 on, shape (times, 2)."""
    builder = DiagramBuilder()
    given = {name: motor[name] for name in FEATURES if name in motor}
    block = builder.AddSystem(Motor(tuple(given), list(given.values())))
    builder.Connect(builder.AddSystem(ConstantVectorSource(demanded)).get_output_port(), block.get_input_port())
    simulator = Simulator(builder.Build())
    simulator.get_mutable_integrator().set_target_accuracy(1e-9)
    found = []
    for time in times:
        simulator.AdvanceTo(time)
        found.append(block.get_output_port().Eval(block.GetMyContextFromRoot(simulator.get_context())))
    return np.array(found)


# One motor


@given(forces, limits, limits)
def test_a_force_keeps_its_direction_and_stays_within_dead_zone_and_limit(force, width, limit):
    asked = np.array(force)
    given_back = np.array(exerted_at_once(tuple(force), {"dead_zone": width, "max_force": limit}))
    length = min(max(np.linalg.norm(asked) - width, 0.0), limit)
    direction = asked / max(np.linalg.norm(asked), 1e-300)
    np.testing.assert_allclose(given_back, length * direction, rtol=1e-9, atol=1e-9)


@given(forces)
def test_within_its_limit_a_force_is_exerted_to_rounding(force):
    np.testing.assert_allclose(exerted_at_once(tuple(force), {"max_force": NOT_LIMITING}), force, rtol=1e-15)


@given(forces, st.floats(0.05, 2.0))
@settings(max_examples=5, deadline=None)
def test_a_lag_answers_a_step_by_an_exponential(force, tau):
    times = np.array([0.1, 0.5, 1.7])
    expected = np.outer(1 - np.exp(-times / tau), force)
    np.testing.assert_allclose(response(force, times, time_constant=tau), expected, atol=1e-6)


def test_a_limited_rate_answers_a_step_by_a_ramp_in_its_direction():
    times, tau = np.array([0.5, 1.0, 2.0, 4.0]), 0.01
    ramp = response([30.0, -40.0], times, time_constant=tau, max_rate=20.0)
    lengths = np.linalg.norm(ramp, axis=1)
    np.testing.assert_allclose(lengths, [10.0, 20.0, 40.0, 50.0], rtol=1e-6)
    np.testing.assert_allclose(ramp, np.outer(lengths, [0.6, -0.8]), rtol=1e-6)


# A robot with motors


@pytest.mark.parametrize("engine", ["blocks", "compiled"])
def test_a_robot_at_its_limit_gathers_speed_as_a_constant_force_says(engine):
    result = simulate(limited(alone(duration=1.0), max_force=0.5), engine=engine)
    asked = np.linalg.norm(result["demanded_force"].values, axis=-1)
    assert asked.min() > 0.5  # at the limit all the time
    assert np.linalg.norm(result["control_force"].values, axis=-1) == pytest.approx(0.5)
    assert metrics(result)["peak_force_n"] == pytest.approx(0.5)
    way = 0.5 / MASS * result["time"].values ** 2 / 2
    # The way turns with the demand, by a thousandth of it.
    np.testing.assert_allclose(np.linalg.norm(result["position"].values[:, 0] - START, axis=1), way, atol=1e-5)


def test_what_is_exerted_moves_the_robots_and_is_what_metrics_see():
    result = simulate(limited(two(), max_force=2.0, time_constant=0.1))
    exerted, asked = (np.linalg.norm(result[name].values, axis=-1) for name in ("control_force", "demanded_force"))
    assert exerted.max() <= 2.0 < asked.max()
    total = result["control_force"] + result["spring_force"]
    np.testing.assert_allclose(result["acceleration"], total / MASS, atol=1e-12)
    assert metrics(result)["peak_force_n"] == pytest.approx(exerted.max())
    names = ("tracking_force", "consensus_force", "avoidance_force")
    np.testing.assert_allclose(sum(result[name] for name in names), result["demanded_force"], atol=1e-12)


def test_motors_without_limits_are_wires():
    plain, motors = (simulate(scenario, engine="blocks") for scenario in (two(), limited(two())))
    assert "demanded_force" not in motors
    np.testing.assert_array_equal(motors["position"], plain["position"])


def test_limits_that_are_never_met_change_nothing_but_rounding():
    plain, motors = (simulate(scenario) for scenario in (two(), limited(two(), max_force=NOT_LIMITING)))
    np.testing.assert_allclose(motors["position"][-1], plain["position"][-1], rtol=0, atol=1e-12)
    np.testing.assert_allclose(motors["control_force"], motors["demanded_force"], rtol=1e-15)


@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    scenario = limited(two(kind="lqi"), max_force=4.0, max_rate=40.0, time_constant=0.05, dead_zone=0.1)
    found, blocks = (simulate(scenario, engine=name)["position"].values[-1] for name in (engine, "blocks"))
    np.testing.assert_allclose(found, blocks, rtol=0, atol=1e-4)


def test_robots_may_have_motors_of_their_own():
    mixed = {"actuator": {"kind": {"1": "motor", "default": "ideal"}, "max_force": {"1": 1.0}}}
    result = simulate(with_overrides(two(), mixed))
    exerted = np.linalg.norm(result["control_force"].values, axis=-1)
    assert exerted[:, 0].max() == pytest.approx(1.0)
    assert exerted[:, 1].max() > 1.0
    np.testing.assert_array_equal(result["demanded_force"][:, 1], result["control_force"][:, 1])


# Windup


def overshoot(time_constant):
    """How far a robot with weak motors and a strong integral goes beyond its goal (m)."""
    scenario = alone(duration=40.0, kind="pid", kp=40.0, ki=10.0, kd=80.0, anti_windup=time_constant)
    result = simulate(limited(scenario, max_force=2.0))
    return (result["position"].values[:, 0] @ -START / np.linalg.norm(START)).max()


def test_an_integral_that_gives_way_overshoots_less():
    assert overshoot(0.5) < 0.5 * overshoot(1e9)


def test_an_integral_whose_actuators_are_ideal_asks_for_nothing_more():
    block = build_diagram(two(kind="lqi")).GetSubsystemByName("robot_1").GetSubsystemByName("tracking")
    assert [block.get_input_port(k).get_name() for k in range(block.num_input_ports())] == ["state", "reference"]


# What is certified, and what is refused


def test_a_largest_force_is_certified_as_unlimited_and_nothing_else_is():
    plain, strong = (linearize(scenario) for scenario in (two(), limited(two(), max_force=5.0)))
    np.testing.assert_allclose(strong.closed_loop(2.0, 1.0), plain.closed_loop(2.0, 1.0), rtol=1e-12)
    np.testing.assert_array_equal(strong.B, plain.B)
    for motor in ({"time_constant": 0.1}, {"max_rate": 5.0}, {"dead_zone": 0.1, "max_force": 5.0}):
        with pytest.raises(IllPosedError, match="robot 1 has actuator 'motor' of drake-formation"):
            linearize(limited(two(), **motor))


@pytest.mark.parametrize(
    ("motor", "message"),
    [
        ({"max_force": -1.0}, r"actuator.max_force: out of range \(got -1.0"),
        ({"max_rate": 0.0}, r"actuator.max_rate: out of range \(got 0.0"),
        ({"time_constant": 0.0}, r"actuator.time_constant: out of range \(got 0.0"),
        ({"dead_zone": -0.1}, r"actuator.dead_zone: out of range \(got -0.1"),
        (
            {"max_force": 1.0, "dead_zone": 1.0},
            r"actuator.dead_zone: .*swallows.* below max_force = 1 N",
        ),
        ({"max_force": [1.0]}, r"actuator.max_force: 1 values for 2 robots"),
        ({"strength": 1.0}, r"actuator.strength: unknown key"),
    ],
)
def test_bad_motors_are_refused_with_the_place(motor, message):
    with pytest.raises(ScenarioError, match=message):
        limited(two(), **motor)


def test_limits_of_ideal_actuators_are_refused_with_the_kind_that_has_them():
    with pytest.raises(ScenarioError, match=r"actuator.max_force: unknown key; allowed: kind; with kind: motor also"):
        with_overrides(two(), {"actuator": {"max_force": 1.0}})
