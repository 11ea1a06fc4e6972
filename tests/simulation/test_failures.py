"""Robots that fail: what physics says of them, and what the others do."""

import numpy as np
import pytest
from carrying import carried

from drake_formation import build_diagram, load_scenario, metrics, simulate
from drake_formation.analysis import at_rest, linearize
from drake_formation.scenario import resolve
from drake_formation.scenario.stages import smaller_slots
from drake_formation.simulation import events

ALONE = {
    "aggregation.duration": 0.0,
    "transport.duration": 3.0,
    "avoidance.obstacles": [],
    "springs.graph": [],
    "consensus.graph": [],
    "simulator.accuracy": 1e-9,
}
"""Two robots that nothing couples."""


def failing(*failures, name="line", **more):
    return load_scenario(name, overrides=ALONE | more | {"failures": list(failures)})


def test_a_robot_without_drives_and_load_keeps_its_velocity():
    result = simulate(failing({"robot": 1, "time": 1.0, "kind": "stops_actuating"}), engine="blocks")
    after = result.sel(robot=1, time=slice(1.0, None))
    start, velocity = after["position"].values[0], after["velocity"].values[0]
    times = after["time"].values - 1.0
    np.testing.assert_allclose(after["position"], start + times[:, None] * velocity, rtol=1e-12)
    assert np.linalg.norm(velocity) > 0.1
    for name in ("control_force", "acceleration"):
        assert (after[name].values == 0).all()
    assert after["driven"].values.tolist() == [0] * len(times)
    other = simulate(failing(), engine="blocks")
    np.testing.assert_allclose(result["position"].sel(robot=2)[-1], other["position"].sel(robot=2)[-1], rtol=1e-8)


def test_a_robot_that_freezes_stops_as_its_brakes_say_whatever_pulls_it():
    """v̇ = −v/τ brings it to q + τ v."""
    freezes = {"robot": 1, "time": 1.0, "kind": "freezes", "brake_time": 0.1}
    coupled = {"springs.graph": "complete", "springs.stiffness": 50.0}
    results = [simulate(failing(freezes, **coupled), engine=engine) for engine in ("blocks", "compiled")]
    for result in results:
        then, last = (result.sel(robot=1, time=time) for time in (1.0, 3.0))
        expected = then["position"].values + 0.1 * then["velocity"].values
        np.testing.assert_allclose(last["position"], expected, atol=1e-9)
        np.testing.assert_allclose(last["velocity"], 0.0, atol=1e-8)
        assert float(np.linalg.norm(last["spring_force"])) > 1.0, "the other pulls it"
    first, second = (result["position"].values[-1] for result in results)
    np.testing.assert_allclose(first, second, atol=1e-7)
    ((event,), (same,)) = map(events, results)
    assert (event.time, event.sentence) == (same.time, same.sentence) == (1.0, "robot 1 freezes")


def test_a_robot_that_drops_its_load_feels_nothing_of_it_and_takes_it_again():
    drops = {"robot": 1, "time": 0.5, "kind": "drops_load", "repaired_at": 2.0}
    coupled = {"springs.graph": "complete", "springs.stiffness": 50.0, "robots.start": [[0.0, 0.0], [0.5, 1.0]]}
    result = simulate(failing(drops, **coupled), engine="blocks")
    time, force = result["time"].values, np.abs(result["spring_force"].values).max(axis=(1, 2))
    dropped = (time >= 0.5) & (time < 2.0)
    assert (force[dropped] == 0).all()
    assert (force[~dropped] > 0).all()
    assert result["acting"].values[:, 0].tolist() == (~dropped).tolist()
    shares = np.abs(result["spring_length"] / result["rest_length"] - 1.0).values[~dropped, 0]
    assert metrics(result).max_spring_strain == pytest.approx(shares.max(), rel=1e-3)
    assert [(event.kind, event.time, event.who) for event in events(result)] == [
        ("failure", 0.5, (1,)),
        ("repair", 2.0, (1,)),
    ]


def test_a_dropped_neighbour_asks_for_nothing_once_it_is_noticed():
    fails = {"robot": 1, "time": 1.0, "kind": "freezes", "response": "drop_neighbour", "notice_after": 0.5}
    result = simulate(failing(fails, **{"consensus.graph": "complete", "consensus.delta": 100.0}), engine="blocks")
    time, force = result["time"].values, np.abs(result["consensus_force"].values).max(axis=2)
    assert force[time >= 1.5].max() < 1e-11
    assert (force[(time > 1.0) & (time < 1.5)] > 1e-3).all()
    reached = result["position"].sel(robot=2, time=time[-1])
    alone = simulate(failing(), engine="blocks")
    assert float(np.linalg.norm(reached - alone["position"].sel(robot=2)[-1])) > 1e-3, "it was held back until then"


SQUARE = {
    "consensus.graph": "complete",
    "consensus.delta": 200.0,
    "transport.duration": 40.0,
    "transport.goal": [3.0, 3.5],
    "robots.start": {"centre": [2.5, 3.5]},
    "tracking.Q": [100.0, 100.0, 400.0, 400.0],
}


def test_the_others_form_a_triangle_where_one_of_four_is_lost():
    """The three are at rest where three robots of the smaller formation with their part of the object are."""
    coupled = {"springs.graph": "complete", "springs.stiffness": 20.0, "springs.damping": 20.0}
    lost = {"robot": 2, "time": 2.0, "kind": "drops_load", "response": "re_form"}
    scenario = failing(lost, name="quadrilateral", **SQUARE, **coupled)
    slots, left = smaller_slots(scenario, {1}), [0, 2, 3]
    springs = resolve(scenario).springs
    kept = [k for k, pair in enumerate(springs.pairs.tolist()) if 1 not in pair]
    small = {
        "formation": {"shape": "slots", "slots": slots[left].tolist()},
        "springs.rest_length": resolve(scenario).rest_lengths[kept].tolist(),
        "robots.start": {"centre": [3.0, 3.5]},
    }
    three = simulate(failing(name="quadrilateral", **SQUARE | coupled | small), engine="blocks")
    four = simulate(scenario, engine="blocks")
    np.testing.assert_allclose(four["position"].values[-1][left], three["position"].values[-1], atol=2e-4)
    assert np.abs(four["spring_force"].values[-1]).max() > 1.0, "the object is bent to the smaller shape"
    np.testing.assert_allclose(four["position"].values[-1][1], np.add([3.0, 3.5], slots[1]), atol=2e-3)


def test_without_an_object_they_are_in_the_slots_of_the_triangle_until_the_fourth_is_back():
    lost = {"robot": 2, "time": 2.0, "kind": "stops_actuating", "response": "re_form", "repaired_at": 30.0}
    scenario = failing(lost, name="quadrilateral", **SQUARE)
    result = simulate(scenario, engine="blocks")
    slots, left = smaller_slots(scenario, {1}), [0, 2, 3]
    before = result.sel(time=slice(None, 30.0 - 1e-7)).isel(time=-1)
    position = before["position"].values[left]
    np.testing.assert_allclose(position, np.add(slots, [3.0, 3.5])[left], atol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(position - np.roll(position, 1, axis=0), axis=1), 1.0, atol=2e-3)
    assert np.abs(before["tracking_error"].values[left]).max() < 1e-3, "against the slots that they have"
    assert np.linalg.norm(before["consensus_error"].values, axis=1).max() > 0.1, "against those as planned"
    then = result.sel(time=slice(30.0, None)).isel(time=0)
    assert np.abs(then["tracking_error"].values[left]).max() > 0.1, "they go back once it is repaired"
    kinds = [event.kind for event in events(result)]
    assert sorted(kinds) == ["failure", "repair", "response"]


@pytest.mark.parametrize("strength", ["", ", grip_strength: 1e6, look_every: 0.05"])
def test_a_grip_that_is_let_go_exerts_nothing_until_it_holds_again(strength):
    failures = "[{robot: 1, time: 0.5, kind: drops_load, repaired_at: 1.0}]"
    scenario = carried(f"{{kind: rigid{strength}}}", failures=failures, aggregation="{duration: 0.2}")
    result = simulate(scenario, engine="blocks")
    time, force = result["time"].values, np.linalg.norm(result["spring_force"].sel(robot=1), axis=1)
    dropped = (time >= 0.5) & (time < 1.0)
    assert (force[dropped] == 0).all()
    assert (force[(time > 0.3) & ~dropped] > 0).all()
    assert result["grip_acting"].sel(robot=1).values.tolist() == (~dropped).tolist()
    assert (result["grip_acting"].sel(robot=[2, 3, 4]).values == 1).all()
    assert float(np.linalg.norm(result["spring_force"].sel(robot=2, time=time[dropped]), axis=1).min()) > 0


@pytest.mark.slow
def test_engines_carry_out_the_same_failures():
    lost = {"robot": 2, "time": 1.0, "kind": "freezes", "response": "re_form", "repaired_at": 2.0, "notice_after": 0.1}
    coupled = {"springs.graph": "complete", "springs.stiffness": 20.0, "springs.break_at_strain": 0.2}
    more = SQUARE | coupled | {"transport.duration": 4.0, "object": {"kind": "springs", "look_every": 0.05}}
    scenario = failing(lost, name="quadrilateral", **more)
    first, *others = (simulate(scenario, engine=engine) for engine in ("blocks", "compiled", "exponential"))
    assert {"failure", "response", "repair"} <= {event.kind for event in events(first)}
    for other in others:
        np.testing.assert_allclose(other["position"].values[-1], first["position"].values[-1], atol=1e-6)
        told = [[(event.time, event.who, event.kind) for event in events(result)] for result in (first, other)]
        assert told[0] == told[1]


def test_a_failure_is_felt_from_its_very_time_on():
    """The sample then shows what is so from then on, in both engines."""
    fails = {"robot": 1, "time": 0.777, "kind": "stops_actuating"}
    for engine in ("blocks", "compiled"):
        result = simulate(failing(fails), engine=engine)
        assert 0.777 in result["time"].values
        forces = np.linalg.norm(result["control_force"].sel(robot=1), axis=1)
        assert ((forces == 0) == (result["time"].values >= 0.777)).all()


def test_a_formation_that_does_not_fail_has_no_block_for_it():
    diagram = build_diagram(failing())
    assert not diagram.HasSubsystemNamed("stages")
    fails = {"robot": 1, "time": 1.0, "kind": "stops_actuating", "response": "drop_neighbour"}
    names = {
        system.get_name() for system in build_diagram(failing(fails, **{"consensus.graph": "complete"})).GetSystems()
    }
    assert {"stages", "stage_1", "robot_1_heeds_2", "robot_2_heeds_1"} <= names


def test_what_is_certified_is_the_formation_before_it_fails():
    lost = {"robot": 2, "time": 2.0, "kind": "freezes", "response": "re_form"}
    coupled = {"springs.graph": "complete", "consensus.graph": "complete"}
    sound, sick = failing(**coupled), failing(lost, **coupled, **{"springs.break_at_strain": 0.5})
    assert at_rest(sick).failures == ()
    np.testing.assert_array_equal(linearize(sick).A, linearize(sound).A)
