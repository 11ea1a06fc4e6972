"""What follows from a scenario's reference, and what is wrong with it."""

import numpy as np
import pytest
from hypothesis import given, settings
from strategies import generators

from drake_formation.parts.references.planner import clearances
from drake_formation.scenario import ScenarioError, load_scenario, resolve, to_yaml
from drake_formation.scenario.resolve import check
from drake_formation.scenario.schema import Scenario
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate

WALL = [{"position": [6.0, 1.8], "radius": 0.5}, {"position": [6.0, -1.8], "radius": 0.5}]


def data(reference=None, **more):
    """Two robots 1 m apart, gathered about the origin; the goal is 12 m ahead."""
    transport = {"goal": [12, 0], "duration": 30} | ({"reference": reference} if reference else {})
    return {
        "name": "test",
        "formation": {"shape": "line", "robots": 2, "side": 1.0},
        "robots": {"start": [[0, -0.5], [0, 0.5]]},
        "transport": transport,
        **more,
    }


def scenario(reference=None, obstacles=()):
    return Scenario.model_validate(data(reference, avoidance={"obstacles": obstacles}))


def faults_of(reference, obstacles=()):
    return [str(fault) for fault in check(scenario(reference, obstacles))]


def reference_of(scenario):
    """The reference's part, and the formation that it is of."""
    formation = resolve(scenario)
    return formation.parts["reference"][0], formation


def motion_duration(scenario):
    part, formation = reference_of(scenario)
    return part.duration(formation)


def trajectory(scenario):
    part, formation = reference_of(scenario)
    return part.trajectory(formation)


def test_a_scenario_has_a_set_point_by_default():
    assert scenario().transport.reference.kind == "set_point"
    assert not scenario().tracking.feed_forward


def test_a_motion_takes_as_long_as_the_transport_by_default():
    assert motion_duration(scenario({"kind": "minimum_jerk"})) == 30
    assert motion_duration(scenario({"kind": "minimum_jerk", "duration": 10})) == 10


@pytest.mark.parametrize(
    ("reference", "obstacles"),
    [
        ({"kind": "minimum_jerk"}, ()),
        ({"kind": "waypoints", "points": [[3, 2]]}, ()),
        ({"kind": "waypoints", "points": [[3, 2], [5, -1], [0, 0]], "duration": 12}, ()),
        ({"kind": "potential_field"}, ()),
        ({"kind": "potential_field"}, WALL[:1]),
        ({"kind": "potential_field", "known": [2], "duration": 12}, WALL),
    ],
)
def test_every_motion_goes_from_where_the_formation_gathers_to_the_goal(reference, obstacles):
    example = scenario(reference, obstacles)
    assert check(example) == []
    motion = trajectory(example)
    assert motion.end_time() == pytest.approx(motion_duration(example), rel=1e-12)
    np.testing.assert_allclose(motion.value(0.0).ravel(), [0, 0], atol=1e-9)
    np.testing.assert_allclose(motion.value(motion.end_time()).ravel(), [12, 0], atol=1e-9)


def test_a_plan_knows_all_obstacles_or_those_it_is_told():
    for known, indices in ((("all"), [0, 1]), ([2], [1]), ([], [])):
        beside = [{**wall, "position": [6.0, 3 * wall["position"][1]]} for wall in WALL]
        part, formation = reference_of(scenario({"kind": "potential_field", "known": known}, beside))
        assert part.known(formation) == indices


def test_what_a_plan_avoids_has_the_formations_size():
    example = scenario({"kind": "potential_field", "known": [1]}, WALL)
    part, formation = reference_of(example)
    assert formation.radius == 0.5
    np.testing.assert_array_equal(part.field(formation).obstacles.discs, [[6, 1.8, 1.0]])


def scattered_obstacles(rng):
    return [
        {"position": position.tolist(), "radius": float(rng.uniform(0, 0.5))}
        for position in rng.uniform([2, -3], [10, 3], (3, 2))
    ]


NARROW = {"kind": "potential_field", "clearance": 0.5, "reach": 1.5}


def test_most_scattered_obstacles_leave_a_plan():
    sound = [not check(scenario(NARROW, scattered_obstacles(np.random.default_rng(seed)))) for seed in range(40)]
    assert sum(sound) >= 20


@settings(max_examples=25)
@given(generators)
def test_a_sound_plan_keeps_every_robot_clear_of_what_it_knows(rng):
    obstacles = scattered_obstacles(rng)
    example = scenario(NARROW, obstacles)
    if faults := check(example):
        assert all("plan" in fault.message or "obstacle" in fault.message for fault in faults)
        return
    motion = trajectory(example)
    centres = motion.vector_values(np.linspace(0, motion.end_time(), 1500)).T
    discs = resolve(example).obstacles
    for slot in ([0, -0.5], [0, 0.5]):
        assert clearances(centres + slot, discs).min() > 0.7 * 0.5


@pytest.mark.parametrize(
    ("reference", "obstacles", "fault"),
    [
        (
            {"kind": "minimum_jerk", "duration": 31},
            (),
            "transport.reference.duration: the motion takes longer than the transport, so the goal is not reached in "
            "time (got 31.0); allowed: at most transport.duration, 30 s",
        ),
        (
            {"kind": "minimum_jerk", "duration": 1e-5},
            (),
            "transport.reference.duration: no duration of a motion (got 1e-05); allowed: from 0.001 to 1e+06 s, or a "
            "set point as reference",
        ),
        (
            {"kind": "waypoints", "points": [[3, 2], [3, 2]]},
            (),
            "transport.reference.points.1: point 1 and point 2 are one place (got [3.0, 2.0]); "
            "allowed: points more than 1.28e-05 m apart",
        ),
        (
            {"kind": "waypoints", "points": [[0, 0]]},
            (),
            "transport.reference.points.0: where the formation gathers and point 1 are one place (got [0.0, 0.0]); "
            "allowed: points more than 1.2e-05 m apart",
        ),
        (
            {"kind": "waypoints", "points": [[3, 2], [12, 0]]},
            (),
            "transport.reference.points.1: point 2 and the goal are one place (got [12.0, 0.0]); "
            "allowed: points more than 1.28e-05 m apart",
        ),
        (
            {"kind": "potential_field", "known": [3]},
            WALL,
            "transport.reference.known.0: there is no obstacle 3 (got 3); allowed: numbers of obstacles from 1 to 2",
        ),
        (
            {"kind": "potential_field", "known": [1]},
            (),
            "transport.reference.known.0: there is no obstacle 1 (got 1); allowed: none, there are no obstacles",
        ),
        (
            {"kind": "potential_field", "known": [2, 1, 2]},
            WALL,
            "transport.reference.known.2: the same obstacle as entry 0 (got 2); allowed: each once",
        ),
        (
            {"kind": "potential_field", "clearance": 3},
            (),
            "transport.reference.reach: not beyond the clearance (got 2.6); "
            "allowed: more than transport.reference.clearance, 3 m",
        ),
        (
            {"kind": "potential_field"},
            [{"position": [1.5, 0.0]}],
            "robots.start: the formation gathers nearer to obstacle 1 than the plan's clearance (got [0.0, 0.0]); "
            "allowed: a formation centre more than 1.8 m from it, or a smaller transport.reference.clearance",
        ),
        (
            {"kind": "potential_field", "known": [2]},
            [{"position": [5, 5]}, {"position": [11.0, 1.0], "radius": 0.2}],
            "transport.goal: the formation at the goal is nearer to obstacle 2 than the plan's clearance "
            "(got [12.0, 0.0]); allowed: a formation centre more than 2 m from it, or a smaller "
            "transport.reference.clearance",
        ),
    ],
)
def test_what_is_wrong_is_told(reference, obstacles, fault):
    assert faults_of(reference, obstacles) == [fault]


def test_a_plan_without_a_way_is_refused_with_the_place_where_it_is_stuck():
    (fault,) = faults_of({"kind": "potential_field"}, WALL)
    assert fault.startswith("transport.reference: the plan gets stuck between known obstacles at [4.4")
    assert fault.endswith("fewer known obstacles, or points of your own (kind waypoints)")


def test_a_plan_between_known_obstacles_too_small_for_its_pieces_is_refused():
    # 4000 m in 20 pieces: the curve through their ends knows nothing of a disc of 1 m.
    example = data({"kind": "potential_field"}, avoidance={"obstacles": [{"position": [1950, 0.3]}]})
    example["transport"]["goal"] = [4000, 0]
    (fault,) = map(str, check(Scenario.model_validate(example)))
    assert fault.startswith("transport.reference.clearance: the plan comes within ")


def test_where_there_is_nothing_to_plan_a_plan_is_refused():
    example = data({"kind": "potential_field"})
    example["transport"]["goal"] = [0, 0]
    (fault,) = map(str, check(Scenario.model_validate(example)))
    assert fault == (
        "transport.goal: where the formation gathers already: nothing to plan (got [0.0, 0.0]); "
        "allowed: another goal, or kind set_point"
    )


def test_a_transport_too_long_for_a_motion_is_told_where_it_is_written():
    example = data({"kind": "minimum_jerk"})
    example["transport"]["duration"] = 1e9
    fault, *_ = map(str, check(Scenario.model_validate(example)))
    assert fault.startswith("transport.duration: no duration of a motion (got 1000000000.0)")


def test_a_kind_is_chosen_like_a_shape():
    with pytest.raises(ScenarioError) as error:
        load_scenario("line", overrides=["transport.reference.kind=way_points"])
    assert str(error.value) == (
        "--set transport.reference.kind=way_points: transport.reference.kind: unknown name (got way_points); "
        "allowed: set_point, minimum_jerk, potential_field, waypoints; did you mean 'waypoints'?"
    )
    with pytest.raises(ScenarioError, match=r"transport\.reference\.kind: missing; allowed: set_point, minimum_jerk"):
        load_scenario("line", overrides=["transport.reference.duration=3"])
    with pytest.raises(ScenarioError, match=r"reference\.points: unknown key; allowed: kind, duration"):
        load_scenario("line", overrides=["transport.reference={kind: minimum_jerk, points: [[1, 2]]}"])


def test_a_kind_alone_can_be_set_from_the_command_line():
    example = load_scenario("line", overrides=["transport.reference.kind=minimum_jerk"])
    assert example.transport.reference.kind == "minimum_jerk"


@pytest.mark.parametrize("kind", ["set_point", "minimum_jerk", "potential_field"])
def test_every_reference_comes_back_from_yaml(kind):
    example = load_scenario("line", overrides={"transport.reference.kind": kind, "tracking.feed_forward": True})
    assert validate(parse(to_yaml(example), "f.yaml")) == example


def test_the_shipped_s_curve_passes_within_range_of_both_obstacles_on_different_sides():
    example = load_scenario("s_curve")
    centres = trajectory(example).vector_values(np.linspace(0, 120, 500)).T
    for obstacle, side in zip(example.avoidance.obstacles, (1, -1), strict=True):
        nearest = centres[np.linalg.norm(centres - obstacle.position, axis=1).argmin()] - obstacle.position
        assert np.linalg.norm(nearest) - resolve(example).radius < example.avoidance.range
        assert np.sign(nearest[1]) == side


WALL_AHEAD = {"kind": "segment", "ends": [[10.0, 2.0], [10.0, 4.5]], "radius": 0.1}


def test_a_plan_goes_round_a_wall_it_knows():
    example = scenario(NARROW, [WALL_AHEAD])
    assert not check(example)
    motion = trajectory(example)
    places = motion.vector_values(np.linspace(0, motion.end_time(), 1500)).T
    assert clearances(places, resolve(example).obstacles).min() > 0.7 * 0.5 + 0.5


def test_what_is_said_to_be_unknown_no_plan_knows():
    hidden = WALL_AHEAD | {"known": False}
    straight = trajectory(scenario(NARROW, [])).vector_values(np.linspace(0, 1, 50))
    np.testing.assert_array_equal(trajectory(scenario(NARROW, [hidden])).vector_values(np.linspace(0, 1, 50)), straight)
    (fault,) = check(scenario(NARROW | {"known": [1]}, [hidden]))
    assert fault.message == "obstacle 1 is said to be unknown"


def test_no_plan_is_made_around_what_moves():
    moving = WALL_AHEAD | {"velocity": [0.0, 0.1]}
    (fault,) = check(scenario(NARROW, [moving]))
    assert "obstacle 1 moves" in fault.message
    assert not check(scenario(NARROW, [moving | {"known": False}]))
