"""References wired into the diagram: exact tracking, structure, and numbers that change without a rebuild."""

import numpy as np
import pytest
from probe import context_at, derivatives, parameters, robot_outputs
from pydrake.systems.analysis import Simulator
from strategies import random_state

from drake_formation.diagram import build_diagram
from drake_formation.parameters import set_parameters, structure
from drake_formation.scenario import load_scenario, resolve, with_overrides
from drake_formation.simulation import simulate

REFERENCES = {
    "minimum_jerk": {"kind": "minimum_jerk", "duration": 20.0},
    "waypoints": {"kind": "waypoints", "points": [[8.0, 1.0], [15.0, 6.0]], "duration": 20.0},
    "potential_field": {"kind": "potential_field", "duration": 20.0},
}
moving = pytest.mark.parametrize("reference", REFERENCES.values(), ids=REFERENCES)


def trajectory(scenario):
    formation = resolve(scenario)
    return formation.parts["reference"][0].trajectory(formation)


def quadrilateral(**changes):
    return load_scenario("quadrilateral", overrides=changes)


def lone_robot(reference, **changes):
    """One robot without obstacles in range, at rest in its slot when the transport begins."""
    return load_scenario(
        "line",
        overrides={
            "formation": {"shape": "line", "robots": 1, "side": 1.0},
            "robots.start": [[2.5, 3.5]],
            "avoidance.gain": 0.0,
            "aggregation.duration": 2.0,
            "transport.duration": 22.0,
            "transport.reference": reference,
            **changes,
        },
    )


@moving
def test_with_feed_forward_a_robot_on_its_reference_stays_there(reference):
    result = simulate(lone_robot(reference, **{"tracking.feed_forward": True}))
    assert float(np.abs(result["tracking_error"]).max()) < 1e-5
    np.testing.assert_allclose(result["position"].values[-1, 0], [25.0, 3.5], atol=1e-5)
    np.testing.assert_array_equal(result["position"].where(result["phase"] == 0, drop=True).values[0, 0], [2.5, 3.5])


@moving
def test_the_papers_law_alone_lags_behind(reference):
    result = simulate(lone_robot(reference))
    assert float(np.abs(result["tracking_error"]).max()) > 1


def test_feed_forward_is_every_robots_own_mass_times_acceleration():
    masses = [10.0, 20.0, 30.0, 40.0]
    changes = {"robots.mass": masses, "aggregation.duration": 0.0, "transport.reference": REFERENCES["waypoints"]}
    without, ahead = (build_diagram(quadrilateral(**changes, **{"tracking.feed_forward": on})) for on in (False, True))
    state = random_state(quadrilateral(), np.random.default_rng(0))
    forces = []
    for diagram in (without, ahead):
        context = context_at(diagram, state)
        context.SetTime(6.0)
        forces.append(robot_outputs(diagram, context, "tracking_force"))
        reference = diagram.GetSubsystemByName("reference")
        acceleration = reference.GetOutputPort("centre").Eval(reference.GetMyContextFromRoot(context))[4:]
    np.testing.assert_allclose(forces[1] - forces[0], np.outer(masses, acceleration), atol=1e-12)


@moving
def test_the_reference_waits_for_the_hand_off(reference):
    scenario = quadrilateral(**{"transport.reference": reference})
    diagram = build_diagram(scenario)
    block, context = diagram.GetSubsystemByName("reference"), diagram.CreateDefaultContext()
    motion = trajectory(scenario)
    for time in (0.0, 29.9, 30.0, 37.0, 50.0, 80.0):
        context.SetTime(time)
        centre = block.GetOutputPort("centre").Eval(block.GetMyContextFromRoot(context))
        elapsed = np.clip(time - resolve(scenario).hand_off, 0, 20)
        expected = [motion.EvalDerivative(elapsed, k).ravel() for k in range(3)]
        np.testing.assert_allclose(centre, np.concatenate(expected), atol=1e-9)


@moving
@pytest.mark.parametrize("scheme", ["runge_kutta5", "runge_kutta3"])
def test_no_scheme_works_with_a_stale_reference(reference, scheme):
    """An output that does not list the clock among what it depends on goes stale within a step."""
    scenario = lone_robot(reference, **{"tracking.feed_forward": True, "simulator.integration_scheme": scheme})
    simulator = Simulator(build_diagram(scenario))
    context = simulator.get_context()
    simulator.AdvanceTo(12.0)
    expected = trajectory(scenario).value(10.0).ravel()
    np.testing.assert_allclose(context.get_continuous_state_vector().CopyToVector()[:2], expected, atol=0.01)


@moving
def test_a_diagram_has_no_inputs_or_loops_and_the_structure_of_its_scenario(reference):
    scenario = quadrilateral(**{"transport.reference": reference})
    diagram = build_diagram(scenario)
    assert diagram.num_input_ports() == 0
    assert not diagram.HasAnyDirectFeedthrough()
    assert structure(resolve(scenario)) == diagram.structure


CHANGES = {
    "another duration": (REFERENCES["minimum_jerk"], {"transport.reference.duration": 15.0}),
    "another goal": (REFERENCES["minimum_jerk"], {"transport.goal": [3.0, 8.0]}),
    "feed-forward": (REFERENCES["minimum_jerk"], {"tracking.feed_forward": True}),
    "another point": (REFERENCES["waypoints"], {"transport.reference.points.0": [9.0, 2.0]}),
    "another clearance": (REFERENCES["potential_field"], {"transport.reference.clearance": 1.0}),
    "another known obstacle": (REFERENCES["potential_field"], {"avoidance.obstacles.0.position": [5.0, 5.5]}),
    "fewer known obstacles": (REFERENCES["potential_field"], {"transport.reference.known": [2]}),
    "other starts": (REFERENCES["waypoints"], {"robots.start": {"centre": [0.0, 1.0]}}),
}


@pytest.mark.parametrize(("reference", "change"), CHANGES.values(), ids=CHANGES)
def test_every_number_of_a_reference_can_be_changed_and_matters(reference, change):
    scenario = quadrilateral(**{"transport.reference": reference, "aggregation.duration": 0.0})
    variant = with_overrides(scenario, change)
    diagram, rebuilt = build_diagram(scenario), build_diagram(variant)
    state = random_state(scenario, np.random.default_rng(0))
    context, expected = context_at(diagram, state), context_at(rebuilt, state)
    for each in (context, expected):
        each.SetTime(5.0)
    before = derivatives(diagram, context)
    set_parameters(diagram, context, variant)
    np.testing.assert_array_equal(parameters(context), parameters(expected))
    np.testing.assert_array_equal(derivatives(diagram, context), derivatives(rebuilt, expected))
    assert (derivatives(diagram, context) != before).any()


@pytest.mark.parametrize(
    "change",
    [
        {"transport.reference": {"kind": "set_point"}},
        {"transport.reference": REFERENCES["minimum_jerk"]},
        {"transport.reference": REFERENCES["potential_field"]},
        {"transport.reference.points": [[8.0, 1.0], [12.0, 3.0], [15.0, 6.0]]},
    ],
)
def test_other_pieces_are_another_structure(change):
    scenario = quadrilateral(**{"transport.reference": REFERENCES["waypoints"]})
    diagram = build_diagram(scenario)
    context = diagram.CreateDefaultContext()
    before = parameters(context)
    with pytest.raises(ValueError, match="pieces of the reference"):
        set_parameters(diagram, context, with_overrides(scenario, change))
    np.testing.assert_array_equal(parameters(context), before)


@pytest.mark.parametrize("convert", ["ToAutoDiffXd", "ToSymbolic"])
@moving
def test_a_diagram_converts(reference, convert):
    diagram = build_diagram(quadrilateral(**{"transport.reference": reference, "tracking.feed_forward": True}))
    context = diagram.CreateDefaultContext()
    context.SetTime(41.0)
    other = getattr(diagram, convert)()
    other_context = other.CreateDefaultContext()
    other_context.SetTimeStateAndParametersFrom(context)
    numbers = [x.value() if convert == "ToAutoDiffXd" else x.Evaluate() for x in derivatives(other, other_context)]
    np.testing.assert_allclose(numbers, derivatives(diagram, context), rtol=1e-12, atol=1e-12)
