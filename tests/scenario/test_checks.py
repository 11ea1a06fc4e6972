import sys
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_formation.scenario.load import load_scenario, shipped_scenarios
from drake_formation.scenario.overrides import plain
from drake_formation.scenario.resolve import check
from drake_formation.scenario.schema import Scenario


def scenario(**changes):
    """Three robots in a row; a dotted path with __ for each dot changes a value."""
    data = {
        "name": "test",
        "formation": {"shape": "line", "robots": 3, "side": 1.0},
        "robots": {"start": [[0, 0], [0, 1], [0, 2]]},
        "transport": {"goal": [10, 0]},
    }
    for path, value in changes.items():
        *sections, key = path.split("__")
        section = data
        for name in sections:
            section = section.setdefault(name, {})
        section[key] = value
    return Scenario.model_validate(data)


def faults_of(**changes):
    return [str(fault) for fault in check(scenario(**changes))]


def polygon(robots, **size):
    return {"formation": {"shape": "polygon", "robots": robots, **size}, "robots__start": {"centre": [0, 0]}}


OBSTACLE = [{"position": [0.0, 1.0], "radius": 0.5}]
FOUR_BY_FOUR = "symmetric, positive semi-definite 4 x 4, weighting both positions"
TWO_BY_TWO = "symmetric, positive definite 2 x 2"
EYE = np.eye(4).tolist()


def changed(matrix, row, column, value):
    copy = plain(matrix)
    copy[row][column] = value
    return copy


SQUARE = [[4.0, 0.0], [5.0, 0.0], [5.0, 1.0], [4.0, 1.0]]


def shaped(**obstacle):
    return {"avoidance__obstacles": [obstacle]}


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        (shaped(kind="segment", ends=[[4, 4], [4, 4]]), "avoidance.obstacles.0.ends.1: a segment's ends are in one"),
        (
            shaped(kind="polygon", vertices=[*SQUARE, SQUARE[0]]),
            "avoidance.obstacles.0.vertices.0: two corners in a row are in one place",
        ),
        (
            shaped(kind="polygon", vertices=[SQUARE[k] for k in (0, 2, 1, 3)]),
            "avoidance.obstacles.0.vertices: the polygon's edges cross or touch at [4.5, 0.5]",
        ),
        (
            shaped(kind="polygon", vertices=[[4, 4], [6, 4], [5, 4]]),
            "avoidance.obstacles.0.vertices: the polygon's edges cross or touch",
        ),
        (
            shaped(position=[4, 4], velocity=[1, 0], waypoints=[{"time": 1, "position": [5, 4]}]),
            "avoidance.obstacles.0.waypoints: both velocity and waypoints are given; allowed: one of them",
        ),
        (
            shaped(position=[4, 4], start=2, waypoints=[{"time": 2, "position": [5, 4]}]),
            "avoidance.obstacles.0.waypoints.0.time: no later than start, 2 s (got 2.0)",
        ),
        (
            shaped(kind="polygon", vertices=[[-1, 0.5], [1, 0.5], [1, 1.5], [-1, 1.5]]),
            "robots.start.1: robot 2 starts inside obstacle 1",
        ),
        (
            shaped(kind="segment", ends=[[9, 0.1], [11, 0.1]], radius=0.2),
            "transport.goal: robot 2's slot at the goal is inside obstacle 1 (got [10.0, 0.0]); allowed: more than "
            "0.2 m from [[9.0, 0.1], [11.0, 0.1]]",
        ),
        (
            shaped(position=[4, 0], velocity=[0.1, 0.0]) | {"transport__duration": 60.0},
            "transport.goal: robot 2's slot at the goal is inside obstacle 1 (got [10.0, 0.0]); allowed: more than "
            "0 m from [4.0, 0.0], which moves",
        ),
        (
            shaped(position=[0, -0.5], radius=0.3) | {"robots__radius": [0.3, 0.2, 0.2]},
            "robots.start.0: robot 1 starts inside obstacle 1 (got [0.0, 0.0]); allowed: more than 0.6 m from [0.0, "
            "-0.5]",
        ),
        ({"robots__radius": 0.5}, "robots.radius: robots 1 and 2 touch in their slots (got 0.5)"),
        ({"robots__radius": [0.1, 0.2]}, "robots.radius: 2 values for 3 robots"),
    ],
)
def test_faults_of_shapes_and_footprints(changes, fault):
    assert any(found.startswith(fault) for found in faults_of(**changes)), faults_of(**changes)


def test_a_sound_scenario_has_no_faults():
    assert faults_of() == []


@pytest.mark.parametrize("name", shipped_scenarios())
def test_the_shipped_scenarios_are_sound(name):
    assert check(load_scenario(name)) == []


@pytest.mark.parametrize(
    ("changes", "fault"),
    [
        (polygon(4), "formation: neither side nor width is given; allowed: side or width (m)"),
        (polygon(4, side=1.0, width=1.0), "formation: both side and width are given; allowed: side or width (m)"),
        (
            polygon(5, width=1.0),
            "formation.width: a polygon of 5 corners has no two parallel sides to measure a width across (got 1.0); "
            "allowed: side, or width for 4, 6, 8 … robots",
        ),
        (
            polygon(2, width=1.0),
            "formation.width: a polygon of 2 corners has no two parallel sides to measure a width across (got 1.0); "
            "allowed: side, or width for 4, 6, 8 … robots",
        ),
        (
            {"formation": {"shape": "grid", "rows": 40, "columns": 40, "side": 1.0}},
            "formation.rows: 1600 robots are too many; allowed: at most 1000 robots",
        ),
        (
            {"robots__start": [[0, 0], [0, 1]]},
            "robots.start: 2 starting positions for 3 robots (got [[0.0, 0.0], [0.0, 1.0]]); "
            "allowed: 3 positions [x, y] (m), one a robot",
        ),
        (
            {"robots__start": [[0, 0], [0, 1], [0, 1e-10]]},
            "robots.start.2: robots 1 and 3 start on one spot (got [0.0, 1e-10]); "
            "allowed: starting positions more than 1e-09 m apart",
        ),
        (
            {"formation": {"shape": "slots", "slots": [[0, 0], [1, 0], [1, 0]]}},
            "formation.slots.2: robots 2 and 3 have the same slot (got [1.0, 0.0]); "
            "allowed: slots more than 1e-09 m apart",
        ),
        (
            {"avoidance__obstacles": OBSTACLE},
            "robots.start.1: robot 2 starts inside obstacle 1 (got [0.0, 1.0]); "
            "allowed: more than 0.5 m from [0.0, 1.0]",
        ),
        (
            {"avoidance__obstacles": OBSTACLE, "robots__start": {"centre": [0, 0]}},
            "robots.start: robot 3 starts inside obstacle 1 (got [0.0, 1.0]); allowed: more than 0.5 m from [0.0, 1.0]",
        ),
        (
            {"avoidance__obstacles": [{"position": [10.0, -1.0]}]},
            "transport.goal: robot 1's slot at the goal is inside obstacle 1 (got [10.0, -1.0]); "
            "allowed: more than 0 m from [10.0, -1.0]",
        ),
        (
            {
                "avoidance__obstacles": [{"position": [1.0, 1.0]}],
                "robots__start": [[0, 1], [1, 4], [2, -2]],
                "aggregation__duration": 1.0,
            },
            "robots.start: the formation gathers about the mean start with robot 2 inside obstacle 1 "
            "(got [1.0, 1.0]); allowed: more than 0 m from [1.0, 1.0]",
        ),
        (
            {"robots__mass": [1, 2]},
            "robots.mass: 2 values for 3 robots (got [1.0, 2.0]); allowed: one for all, or 3, one a robot",
        ),
        (
            {"springs__stiffness": [1, 2]},
            "springs.stiffness: 2 values for 3 edges (got [1.0, 2.0]); "
            "allowed: one for all, or 3 in the order of the edges: 1-2, 1-3, 2-3",
        ),
        (
            {"springs__damping": [1, 2, 3], "springs__graph": "path"},
            "springs.damping: 3 values for 2 edges (got [1.0, 2.0, 3.0]); "
            "allowed: one for all, or 2 in the order of the edges: 1-2, 2-3",
        ),
        (
            {"springs__stiffness": [1, 2], "springs__graph": [[2, 3], [2, 1]]},
            "springs.graph: edges out of order for the values of stiffness (got [[2, 3], [2, 1]]); "
            "allowed: ascending: 1-2, 2-3",
        ),
        (
            {"springs__graph": [[1, 4]]},
            "springs.graph.0: there is no robot 4 (got [1, 4]); allowed: two of the robots 1 to 3",
        ),
        (
            {"consensus__graph": [[1, 2], [0, 1]]},
            "consensus.graph.1: there is no robot 0 (got [0, 1]); allowed: two of the robots 1 to 3",
        ),
        (
            {"springs__graph": [[2, 2]]},
            "springs.graph.0: an edge from a robot to itself (got [2, 2]); allowed: two of the robots 1 to 3",
        ),
        (
            {"consensus__graph": [[1, 2], [2, 1]]},
            "consensus.graph.1: the same edge as entry 0 (got [2, 1]); "
            "allowed: every edge once; edges have no direction",
        ),
        *(
            (
                {"consensus__graph": [[1, 3]], f"consensus__{gain}": 1.0},
                "consensus.graph: no channel between robots {1, 3} and {2}, so they reach no consensus (Lemma 1) "
                "(got [[1, 3]]); allowed: a connected graph while delta or delta_v is above 0",
            )
            for gain in ("delta", "delta_v")
        ),
        (
            {"tracking__Q": [1, 2]},
            f"tracking.Q: a diagonal of 2 entries, not 4 (got [1.0, 2.0]); allowed: {FOUR_BY_FOUR}",
        ),
        ({"tracking__Q": []}, f"tracking.Q: a diagonal of 0 entries, not 4 (got []); allowed: {FOUR_BY_FOUR}"),
        (
            {"tracking__Q": [[1, 2], [3]]},
            f"tracking.Q: not 4 rows of 4 entries (got [[1.0, 2.0], [3.0]]); allowed: {FOUR_BY_FOUR}",
        ),
        ({"tracking__Q": -1}, f"tracking.Q: not positive semi-definite (got -1.0); allowed: {FOUR_BY_FOUR}"),
        (
            {"tracking__Q": 0},
            "tracking.Q: a position costs nothing, so the mode at 0 is not detectable (got 0.0); "
            f"allowed: {FOUR_BY_FOUR}",
        ),
        (
            {"tracking__Q": [1, 0, 1, 1]},
            "tracking.Q: a position costs nothing, so the mode at 0 is not detectable (got [1.0, 0.0, 1.0, 1.0]); "
            f"allowed: {FOUR_BY_FOUR}",
        ),
        ({"tracking__R": [1]}, f"tracking.R: a diagonal of 1 entries, not 2 (got [1.0]); allowed: {TWO_BY_TWO}"),
        (
            {"tracking__R": [[1, 0.5], [0, 1]]},
            f"tracking.R: not symmetric (got [[1.0, 0.5], [0.0, 1.0]]); allowed: {TWO_BY_TWO}",
        ),
        ({"tracking__R": 0}, f"tracking.R: not positive definite (got 0.0); allowed: {TWO_BY_TWO}"),
        (
            {"tracking__R": [[1, 2], [2, 1]]},
            f"tracking.R: not positive definite (got [[1.0, 2.0], [2.0, 1.0]]); allowed: {TWO_BY_TWO}",
        ),
        (
            {"tracking__Q": 1e300},
            "tracking: Drake finds no stabilizing gain for a robot of 40 kg; "
            "allowed: Q, R and masses of less different sizes",
        ),
        (
            {"robots__mass": [1, 1e-300, 1]},
            "tracking: Drake finds no stabilizing gain for a robot of 1e-300 kg; "
            "allowed: Q, R and masses of less different sizes",
        ),
    ],
)
def test_faults(changes, fault):
    assert faults_of(**changes) == [fault]


def test_asymmetric_and_indefinite_state_costs():
    (asymmetric,) = faults_of(tracking__Q=changed(EYE, 0, 1, 0.1))
    assert asymmetric.startswith("tracking.Q: not symmetric")
    (indefinite,) = faults_of(tracking__Q=changed(EYE, 3, 3, -1e-3))
    assert indefinite.startswith("tracking.Q: not positive semi-definite")
    assert faults_of(tracking__Q=changed(EYE, 3, 3, 0.0)) == []  # velocities may cost nothing


def test_rounding_does_not_make_a_cost_asymmetric():
    factor = np.random.default_rng(0).normal(size=(4, 4))
    assert faults_of(tracking__Q=(factor @ factor.T @ factor @ factor.T).tolist()) == []


def test_coincident_slots_of_a_tiny_shape_are_told_once():
    (fault, *more) = faults_of(**polygon(3, side=1e-10))
    assert fault.startswith("formation: robots 1 and 2 have the same slot")
    assert all("have the same slot" in other for other in more)


def test_an_unknown_integrator_gets_the_nearest_name():
    (fault,) = faults_of(simulator__integration_scheme="runge_kuta3")
    assert fault.startswith("simulator.integration_scheme: not one of Drake's integration schemes (got runge_kuta3)")
    assert "runge_kutta5" in fault.split("allowed: ")[1]
    assert fault.endswith("did you mean 'runge_kutta3'?")


def test_a_scheme_that_drake_gets_wrong_for_several_robots_is_refused():
    (fault,) = faults_of(simulator__integration_scheme="velocity_implicit_euler")
    assert "several blocks" in fault
    assert fault.endswith("runge_kutta5, semi_explicit_euler")
    one = {"formation": {"shape": "line", "robots": 1, "side": 1.0}, "robots__start": [[0, 0]]}
    assert faults_of(simulator__integration_scheme="velocity_implicit_euler", **one) == []


@pytest.mark.parametrize(
    ("scheme", "accuracy", "fault"),
    [
        ("runge_kutta5", 2e-3, "looser than runge_kutta5 goes (got 0.002); allowed: 1e-14 to 0.001"),
        ("radau3", 0.02, "looser than radau3 goes (got 0.02); allowed: 1e-14 to 0.01"),
        ("runge_kutta3", 1e-15, "tighter than double precision goes (got 1e-15); allowed: 1e-14 to 0.1"),
    ],
)
def test_an_accuracy_that_the_scheme_would_not_keep_is_refused(scheme, accuracy, fault):
    settings = {"simulator__integration_scheme": scheme, "simulator__accuracy": accuracy}
    assert faults_of(**settings) == [f"simulator.accuracy: {fault}"]
    assert faults_of(**settings, simulator__use_error_control=False) == []


def test_an_accuracy_of_fixed_steps_is_no_matter():
    assert faults_of(simulator__integration_scheme="explicit_euler", simulator__accuracy=10.0) == []


def test_steps_without_number_are_refused():
    assert faults_of(simulator__max_step_size=1e-9) == [
        "simulator.max_step_size: 6e+10 steps and more are too many for 60 s (got 1e-09); allowed: at least 6e-07 s"
    ]


def test_integrators_for_multibody_plants_only_are_not_offered():
    (fault,) = faults_of(simulator__integration_scheme="cenic")
    assert "cenic" not in fault.split("allowed: ")[1]


@pytest.mark.parametrize("scheme", ["explicit_euler", "runge_kutta2", "semi_explicit_euler"])
def test_error_control_is_no_fault_where_drake_takes_fixed_steps(scheme):
    assert faults_of(simulator__integration_scheme=scheme, simulator__use_error_control=True) == []


def test_a_disconnected_graph_is_sound_without_consensus():
    assert faults_of(consensus__graph=[], springs__graph=[]) == []


def test_one_robot_needs_no_channel():
    alone = {"formation": {"shape": "line", "robots": 1, "side": 1.0}, "robots__start": [[0, 0]]}
    assert faults_of(**alone, consensus__graph=[], consensus__delta=1.0) == []


def test_all_faults_are_found_at_once():
    faults = check(
        scenario(
            robots__mass=[1],
            robots__start=[[0, 0]],
            springs__graph=[[1, 9]],
            consensus__graph=[[1, 1]],
            tracking__Q=0,
            tracking__R=0,
            simulator__integration_scheme="euler",
        )
    )
    assert [".".join(map(str, fault.path)) for fault in faults] == [
        "robots.start",
        "robots.mass",
        "springs.graph.0",
        "consensus.graph.0",
        "tracking.Q",
        "tracking.R",
        "simulator.integration_scheme",
    ]


def test_a_hundred_robots_are_checked_fast():
    edges = [[i, j] for i in range(1, 101) for j in range(i + 1, 101)]
    crowd = scenario(
        formation={"shape": "grid", "rows": 10, "columns": 10, "side": 1.0},
        robots__start={"random": {"seed": 1, "about": [0, 0], "spread": 10.0}},
        robots__mass=list(range(40, 140)),
        springs__graph=edges,
        springs__stiffness=[1.0] * len(edges),
        consensus__delta=1.0,
    )
    check(crowd)  # imports Drake
    calls = Counter()
    sys.setprofile(lambda frame, event, argument: calls.update([event]))
    try:
        faults = check(crowd)
    finally:
        sys.setprofile(None)
    assert faults == []
    assert calls["call"] + calls["c_call"] < 250_000  # fifty for each of 4950 pairs, their parts included


@settings(deadline=None, max_examples=300)
@given(st.from_type(Scenario))
def test_whatever_its_fields_a_scenario_is_sound_or_has_faults_with_a_path(scenario):
    for fault in check(scenario):
        assert fault.path
        assert fault.message
        assert fault.allowed
