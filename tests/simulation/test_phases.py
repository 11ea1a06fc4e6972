"""Aggregation, hand-off and transport on Drake's plain Simulator."""

import numpy as np
import pytest
from probe import robot_outputs, state_of
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import EventStatus

from drake_formation.diagram import build_diagram
from drake_formation.scenario import load_scenario

HAND_OFF = 1.2345
NEAR = [{"position": [2.0, 3.0], "radius": 0.0}]
"""An obstacle that both robots of the line feel all along."""


@pytest.fixture(scope="module")
def samples():
    """What every step of a default Simulator shows: time, phase, forces."""
    overrides = {"aggregation.duration": HAND_OFF, "avoidance.obstacles": NEAR, "avoidance.range": 10.0}
    diagram = build_diagram(load_scenario("line", overrides=overrides))
    simulator = Simulator(diagram)
    seen = []

    def watch(context):
        forces = [robot_outputs(diagram, context, f"{name}_force") for name in ("spring", "avoidance")]
        phase = diagram.GetOutputPort("phase").Eval(context).item()
        seen.append((context.get_time(), phase, *forces))
        return EventStatus.DidNothing()

    simulator.set_monitor(watch)
    simulator.AdvanceTo(2.0)
    return seen


def test_a_step_ends_exactly_at_the_hand_off(samples):
    times = [time for time, *_ in samples]
    assert HAND_OFF in times
    assert max(times) == 2.0


def test_the_phase_switches_exactly_at_the_hand_off(samples):
    for time, phase, *_ in samples:
        assert phase == (time > HAND_OFF)


def test_springs_and_obstacles_act_from_the_hand_off_on(samples):
    for _, phase, springs, avoidance in samples:
        assert springs.all() == avoidance.all() == bool(phase)
        assert springs.any() == avoidance.any() == bool(phase)


def test_the_step_from_the_hand_off_on_has_springs_and_obstacles_all_along():
    """A run through the hand-off ends where one that is started anew at the hand-off does."""
    overrides = {"aggregation.duration": HAND_OFF, "springs.stiffness": 100.0}
    diagram = build_diagram(load_scenario("line", overrides=overrides))
    through, stopping = (Simulator(diagram) for _ in range(2))
    for simulator in (through, stopping):
        simulator.get_mutable_integrator().set_target_accuracy(1e-9)
    through.AdvanceTo(3.0)
    stopping.AdvanceTo(HAND_OFF)
    stopping.AdvancePendingEvents()
    stopping.Initialize()
    stopping.AdvanceTo(3.0)
    ends = [state_of(simulator.get_context()) for simulator in (through, stopping)]
    np.testing.assert_allclose(*ends, rtol=0, atol=1e-8)


def test_aggregation_ends_about_the_mean_of_the_starts():
    """The paper's finals, up to what is left of the way at the hand-off."""
    scenario = load_scenario("line")
    diagram = build_diagram(scenario)
    simulator = Simulator(diagram)
    simulator.AdvanceTo(scenario.aggregation.duration)
    positions = state_of(simulator.get_context())[:, :2]
    np.testing.assert_allclose(positions, [[2.5, 3.0], [2.5, 4.0]], rtol=0, atol=4e-3)


def test_the_reference_is_the_gathering_and_then_the_goal(samples):
    diagram = build_diagram(load_scenario("line", overrides={"aggregation.duration": HAND_OFF}))
    simulator = Simulator(diagram)
    for end, centre in ((HAND_OFF, [2.5, 3.5]), (2.0, [25.0, 3.5])):
        simulator.AdvanceTo(end)
        context = simulator.get_context()
        errors = robot_outputs(diagram, context, "tracking_error")[:, :2]
        np.testing.assert_allclose(state_of(context)[:, :2] - errors, np.add(centre, [[0, -0.5], [0, 0.5]]), atol=1e-12)


def test_a_later_beginning_shifts_the_hand_off():
    diagram = build_diagram(load_scenario("line", overrides={"aggregation.duration": 1.0, "simulator.start_time": 5.0}))
    simulator = Simulator(diagram)
    simulator.get_mutable_context().SetTime(5.0)
    simulator.AdvanceTo(6.0)
    assert diagram.GetOutputPort("phase").Eval(simulator.get_context()) == 0
    simulator.AdvanceTo(6.001)
    assert diagram.GetOutputPort("phase").Eval(simulator.get_context()) == 1


def test_without_aggregation_the_transport_begins_at_once():
    diagram = build_diagram(load_scenario("line", overrides={"aggregation.duration": 0.0}))
    assert diagram.GetOutputPort("phase").Eval(diagram.CreateDefaultContext()) == 1
