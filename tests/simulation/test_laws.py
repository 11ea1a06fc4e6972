import numpy as np
import pytest
from hypothesis import given, settings
from probe import context_at, robot_outputs
from strategies import generators, random_state, scenarios

from drake_formation import build_diagram, load_scenario, simulate, with_overrides
from drake_formation.parameters import block_parameters
from drake_formation.scenario import resolve
from drake_formation.simulation.laws import ControlLaw, spring_forces


@settings(max_examples=25)
@given(scenarios(), generators)
def test_the_laws_are_the_diagrams(scenario, rng):
    diagram = build_diagram(scenario)
    states = np.array([random_state(scenario, rng) for _ in range(4)])
    law = ControlLaw(scenario, block_parameters(resolve(scenario)))
    found = law(np.zeros((2, 2)), *(part.reshape(2, 2, -1, 2) for part in (states[..., :2], states[..., 2:])))
    expected = [robot_outputs(diagram, context_at(diagram, state), "control_force") for state in states]
    np.testing.assert_allclose(found.reshape(4, -1, 2), expected, rtol=1e-9, atol=1e-9)
    springs = spring_forces(scenario, np.ones(4), states[..., :2], states[..., 2:])
    expected = [robot_outputs(diagram, context_at(diagram, state), "spring_force") for state in states]
    np.testing.assert_allclose(springs, expected, rtol=1e-9, atol=1e-9)
    assert not spring_forces(scenario, np.zeros(4), states[..., :2], states[..., 2:]).any()


@pytest.mark.parametrize("feed_forward", [False, True])
def test_the_law_follows_a_trajectory_as_the_diagram_does(feed_forward):
    overrides = {"aggregation.duration": 1.0, "transport.duration": 5.0, "tracking.feed_forward": feed_forward}
    scenario = load_scenario("s_curve", overrides=overrides)
    result = simulate(scenario, engine="blocks")
    carried = result.isel(time=result["phase"].values == 1)
    law = ControlLaw(scenario, block_parameters(resolve(scenario)))
    found = law(*(carried[name].values for name in ("time", "position", "velocity")))
    np.testing.assert_allclose(found, carried["control_force"], rtol=0, atol=1e-9)


def test_only_the_robot_nearest_to_an_obstacle_is_pushed_where_only_that_senses_it():
    overrides = {"avoidance.sensing": "nearest", "avoidance.obstacles": [{"position": [2.6, 3.1]}]}
    scenario = load_scenario("line", overrides=overrides)
    slots, velocity = resolve(scenario).slots, np.zeros((1, 2, 2))
    numbers = block_parameters(resolve(scenario))
    forces = [
        ControlLaw(variant, numbers)(np.zeros(1), slots[None] + [2.5, 3.3], velocity)
        for variant in (scenario, with_overrides(scenario, {"avoidance.sensing": "in_range"}))
    ]
    assert (forces[0] != forces[1]).any(axis=-1).tolist() == [[False, True]]
