import numpy as np
import pytest
from hypothesis import given, settings
from probe import context_at, robot_outputs
from strategies import generators, random_state, scenarios

from drake_formation import build_diagram, load_scenario, simulate, with_overrides
from drake_formation.measuring.control_law import ControlLaw, StagedLaw, control_law
from drake_formation.parts import Part
from drake_formation.scenario import resolve


@settings(max_examples=25)
@given(scenarios(), generators)
def test_the_laws_are_the_diagrams(scenario, rng):
    diagram = build_diagram(scenario)
    states = np.array([random_state(scenario, rng) for _ in range(4)])
    law = ControlLaw(resolve(scenario))
    found = law(np.zeros((2, 2)), *(part.reshape(2, 2, -1, 2) for part in (states[..., :2], states[..., 2:])))
    expected = [robot_outputs(diagram, context_at(diagram, state), "control_force") for state in states]
    np.testing.assert_allclose(found.reshape(4, -1, 2), expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("law", ["hookean", ["linear", "hookean", "hookean", "linear"]])
def test_the_law_of_consensus_is_each_robots_own(law):
    scenario = load_scenario("quadrilateral", overrides={"consensus": {"law": law, "delta": 50.0, "delta_v": 5.0}})
    diagram = build_diagram(with_overrides(scenario, {"aggregation.duration": 0.0}))
    state = random_state(scenario, np.random.default_rng(1))
    found = ControlLaw(resolve(scenario))(np.zeros(1), state[None, :, :2], state[None, :, 2:])
    expected = robot_outputs(diagram, context_at(diagram, state), "control_force")
    np.testing.assert_allclose(found[0], expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("feed_forward", [False, True])
def test_the_law_follows_a_trajectory_as_the_diagram_does(feed_forward):
    overrides = {"aggregation.duration": 1.0, "transport.duration": 5.0, "tracking.feed_forward": feed_forward}
    scenario = load_scenario("s_curve", overrides=overrides)
    result = simulate(scenario, engine="blocks")
    carried = result.isel(time=result["phase"].values == 1)
    law = ControlLaw(resolve(scenario))
    found = law(*(carried[name].values for name in ("time", "position", "velocity")))
    np.testing.assert_allclose(found, carried["control_force"], rtol=0, atol=1e-9)


def test_the_law_knows_what_fails_and_what_the_others_do():
    lost = {"robot": 2, "time": 1.0, "kind": "stops_actuating", "response": "re_form", "notice_after": 0.5}
    freezes = {"robot": 4, "time": 2.0, "kind": "freezes", "response": "drop_neighbour", "repaired_at": 2.5}
    scenario = load_scenario(
        "quadrilateral",
        overrides={
            "aggregation.duration": 0.0,
            "transport.duration": 3.0,
            "consensus": {"delta": 50.0, "delta_v": 5.0},
            "failures": [lost, freezes],
        },
    )
    result = simulate(scenario, engine="blocks")
    law = control_law(resolve(scenario), np.zeros(0), np.zeros(0))
    found = law(*(result[name].values for name in ("time", "position", "velocity")))
    assert isinstance(law, StagedLaw)
    assert float(np.abs(result["control_force"].sel(robot=2, time=slice(1.0, None))).max()) == 0
    np.testing.assert_allclose(found, result["control_force"], rtol=0, atol=1e-9)


def test_only_the_robot_nearest_to_an_obstacle_is_pushed_where_only_that_senses_it():
    overrides = {"avoidance.sensing": "nearest", "avoidance.obstacles": [{"position": [2.6, 3.1]}]}
    scenario = load_scenario("line", overrides=overrides)
    slots, velocity = resolve(scenario).slots, np.zeros((1, 2, 2))
    forces = [
        ControlLaw(resolve(variant))(np.zeros(1), slots[None] + [2.5, 3.3], velocity)
        for variant in (scenario, with_overrides(scenario, {"avoidance.sensing": "in_range"}))
    ]
    assert (forces[0] != forces[1]).any(axis=-1).tolist() == [[False, True]]


def test_parts_of_other_kinds_are_read_off_what_was_recorded():
    formation = resolve(load_scenario("line"))
    other = formation.changed(parts={**formation.parts, "tracking": (Part(None), Part(None))})
    times, recorded = np.array([0.0, 1.0]), np.arange(8.0).reshape(2, 2, 2)
    law = control_law(other, times, recorded)
    np.testing.assert_array_equal(
        law(np.array([0.5]), np.zeros((1, 2, 2)), np.zeros((1, 2, 2))), recorded.mean(axis=0)[None]
    )
