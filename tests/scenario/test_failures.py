"""What is said of failing robots is checked, and becomes stages."""

import numpy as np
import pytest

from drake_formation import load_scenario
from drake_formation.scenario import ScenarioError, resolve, to_yaml
from drake_formation.scenario.resolve import warnings
from drake_formation.scenario.source import parse
from drake_formation.scenario.stages import smaller_slots, stages
from drake_formation.scenario.validate import validate

STOPS = {"robot": 1, "time": 70.0, "kind": "stops_actuating"}


def scenario(*failures, name="quadrilateral", **more):
    return load_scenario(name, overrides={"failures": [STOPS | failure for failure in failures]} | more)


WRONG = {
    "no such robot": (({"robot": 5},), r"failures\.0\.robot: no such robot \(got 5\); allowed: 1 to 4"),
    "before it begins": (({"time": 1.0},), r"failures\.0\.time: the scenario begins at 2 s \(got 1\.0\)"),
    "repaired before": (({"repaired_at": 60.0},), r"failures\.0\.repaired_at: .*allowed: later than 70 s"),
    "at the same time": (
        ({"repaired_at": 90.0}, {"time": 80.0, "kind": "freezes"}),
        r"failures\.1\.time: .*failures\.0",
    ),
    "none left": (tuple({"robot": k, "response": "re_form"} for k in (1, 2, 3, 4)), r"failures: no robot is left"),
    "an unknown kind": (({"kind": "explodes"},), r"failures\.0\.kind: unknown name"),
    "an unknown response": (({"response": "panic"},), r"failures\.0\.response: unknown name"),
    "a negative time": (({"time": -1.0},), r"failures\.0\.time: out of range"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_cannot_be_is_refused_with_its_place(case):
    failures, message = WRONG[case]
    with pytest.raises(ScenarioError, match=message):
        resolve(scenario(*failures, **{"simulator.start_time": 2.0}))


UNFIT = {
    "robots on wheels": ({}, {"robots.kind": "unicycle"}, r"failures\.0\.kind: a robot of kind 'unicycle'"),
    "no smaller grid": (
        {"response": "re_form"},
        {"formation": {"shape": "grid", "rows": 2, "columns": 2, "side": 1.0}},
        r"failures\.0\.response: a formation of shape grid has no smaller one",
    ),
    "distances": (
        {"response": "re_form"},
        {"consensus.law": "hookean"},
        r"failures\.0\.response: consensus.law 'hookean'",
    ),
    "followers": (
        {"response": "drop_neighbour"},
        {"consensus": {"kind": "leader_follower", "graph": "path"}},
        r"failures\.0\.response: robot 1 coordinates by 'leader_follower'",
    ),
}


@pytest.mark.parametrize("case", UNFIT)
def test_parts_that_cannot_do_it_are_named(case):
    failure, more, message = UNFIT[case]
    with pytest.raises(ScenarioError, match=message):
        resolve(scenario(failure, **more))


NEVER = {
    "after the end": ({"time": 1000.0}, "so that the robot never fails"),
    "noticed too late": ({"response": "re_form", "notice_after": 100.0}, "before the others notice"),
    "repaired too late": ({"repaired_at": 1000.0}, "never repaired"),
    "nothing to drop": (
        {"time": 1.0, "kind": "drops_load", "repaired_at": 2.0},
        "it carries nothing before the hand-off",
    ),
}


@pytest.mark.parametrize("case", NEVER)
def test_what_a_run_does_not_see_is_told(case):
    failure, message = NEVER[case]
    (warning,) = warnings(scenario(failure))
    assert message in warning.message
    assert warning.path[:2] == ("failures", 0)


def test_failures_of_drives_and_of_the_load_go_together():
    both = scenario({"repaired_at": 80.0}, {"kind": "drops_load", "time": 75.0}, {"time": 80.0, "kind": "freezes"})
    assert [stage.time for stage in stages(both)] == [-np.inf, 70.0, 75.0, 80.0]
    last = resolve(both).stages[-1]
    assert (last.drive[0], last.held[0], last.braking[0]) == (0.0, 0.0, 1 / 0.05)


def test_others_notice_and_forget_after_a_while():
    noticed = scenario({"response": "drop_neighbour", "notice_after": 1.0, "repaired_at": 80.0})
    heeded = [(stage.time, stage.heeded[0], stage.drive[0]) for stage in resolve(noticed).stages]
    assert heeded == [(-np.inf, 1, 1), (70.0, 1, 0), (71.0, 0, 0), (80.0, 0, 1), (81.0, 1, 1)]


def test_a_failure_at_the_beginning_is_no_later_stage():
    (only,) = stages(scenario({"time": 2.0}, **{"simulator.start_time": 2.0}))
    assert only.drive.tolist() == [0, 1, 1, 1]


def test_the_smaller_shape_is_regular_about_the_same_centre_and_near():
    octagon = load_scenario("octagon")
    planned = resolve(octagon).slots
    for lost in ({0}, {2, 5}, {0, 1, 2, 3, 4}):
        slots, left = smaller_slots(octagon, lost), sorted(set(range(8)) - lost)
        np.testing.assert_allclose(slots[left].mean(axis=0), 0.0, atol=1e-12)
        radii = np.linalg.norm(slots[left], axis=1)
        np.testing.assert_allclose(radii, radii[0], rtol=1e-12)
        np.testing.assert_array_equal(slots[sorted(lost)], planned[sorted(lost)])
        ways = np.linalg.norm(slots[left] - planned[left], axis=1).sum()
        rng = np.random.default_rng(1)
        for _ in range(20):
            assert ways <= np.linalg.norm(slots[rng.permutation(left)] - planned[left], axis=1).sum() + 1e-12


def test_a_line_closes_up_and_one_robot_alone_is_in_the_centre():
    three = {"shape": "line", "robots": 3, "side": 2.0, "heading": 0.0}
    line = load_scenario("line", overrides={"formation": three, "robots.start": {"centre": [2.0, 3.0]}})
    np.testing.assert_allclose(smaller_slots(line, {1}), [[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]])
    np.testing.assert_allclose(smaller_slots(line, {0, 1})[2], [0.0, 0.0])


def test_failures_are_written_out_and_read_again():
    written = scenario({"repaired_at": 80.0, "response": "re_form"})
    assert validate(parse(to_yaml(written), "again")) == written
