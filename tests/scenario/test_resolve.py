import pickle

import numpy as np
import pytest
from hypothesis import given
from numpy.testing import assert_array_equal
from strategies import scenarios

from drake_formation.formation import graphs
from drake_formation.scenario import ScenarioError, load_scenario, resolve, with_overrides

LINE, OCTAGON = load_scenario("line"), load_scenario("octagon")


def test_users_number_robots_from_1():
    formation = resolve(with_overrides(OCTAGON, {"springs.graph": [[1, 8]], "consensus.graph": "star"}))
    assert formation.springs.pairs.tolist() == [[0, 7]]
    assert formation.channels.heard[0] == tuple(range(1, 8))


def test_one_number_for_all_a_list_or_a_mapping():
    assert_array_equal(resolve(LINE).masses, [40, 40])
    for given_masses in ([30, 50], {"1": 30.0, "2": 50.0}, {"1": 30.0, "default": 50.0}):
        assert_array_equal(resolve(with_overrides(LINE, {"robots.mass": given_masses})).masses, [30, 50])
    assert_array_equal(resolve(with_overrides(LINE, {"robots.mass": {"2": 50.0}})).masses, [40, 50])


def test_values_of_edges_go_by_their_names():
    quadrilateral = load_scenario("quadrilateral", overrides={"springs.stiffness": {"1-3": 7.0, "default": 2.0}})
    formation = resolve(quadrilateral)
    by_edge = dict(
        zip(map(tuple, formation.springs.pairs.tolist()), formation.field("spring", "stiffness"), strict=True)
    )
    assert by_edge == {(i, j): 7.0 if (i, j) == (0, 2) else 2.0 for i in range(4) for j in range(i + 1, 4)}


def test_phases_follow_each_other():
    formation, later = resolve(LINE), resolve(with_overrides(LINE, {"simulator.start_time": 5.0}))
    assert (formation.hand_off, formation.end) == (60.0, 120.0)
    assert (later.hand_off, later.end) == (65.0, 125.0)


def test_a_scenario_is_resolved_once_and_a_copy_anew():
    assert resolve(LINE) is resolve(LINE)
    copy = LINE.model_copy(update={"transport": LINE.transport.model_copy(update={"goal": (30.0, 3.5)})})
    assert_array_equal(resolve(copy).goal, [30.0, 3.5])
    assert_array_equal(resolve(LINE).goal, LINE.transport.goal)


def test_being_resolved_is_not_seen_from_outside():
    known, unknown = load_scenario("line"), load_scenario("line")
    resolve(known)
    resolve(unknown)
    assert known == unknown == pickle.loads(pickle.dumps(known))
    assert "_resolved" not in known.model_dump()


def test_no_array_can_be_written_to():
    formation = resolve(LINE)
    for array in (formation.slots, formation.starts, formation.centre, formation.goal, formation.footprints):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1.0


def test_channels_may_go_one_way_and_weigh():
    graph = [{"speaker": 1, "listener": 2, "weight": 0.5}, [2, 3], {"speaker": 3, "listener": 4}]
    channels = resolve(load_scenario("quadrilateral", overrides={"consensus.graph": graph})).channels
    assert channels.pairs.tolist() == [[1, 0], [1, 2], [2, 1], [3, 2]]
    assert_array_equal(channels.adjacency[1], [0.5, 0, 1, 0])
    assert_array_equal(channels.laplacian.sum(axis=1), np.zeros(4))
    assert (channels.weighted, channels.undirected, channels.agree) == (True, False, True)


@given(scenarios())
def test_what_graphs_say_channels_say(scenario):
    formation = resolve(scenario)
    assert_array_equal(formation.channels.laplacian, graphs.laplacian(formation.channels.graph))
    assert formation.channels.undirected
    for i in range(formation.robots):
        assert list(formation.channels.heard[i]) == graphs.neighbours(formation.channels.graph, i)


FAULTY = {
    "two channels on one edge and direction": (
        {"consensus.graph": [[1, 2], {"speaker": 2, "listener": 1}]},
        "consensus.graph.1: a second channel from robot 2 to robot 1, after entry 0 "
        "(got {speaker: 2, listener: 1, weight: 1.0}); "
        "allowed: one channel an edge and direction; [i, j] is one each way",
    ),
    "a robot that there is not": (
        {"consensus.graph": [{"speaker": 3, "listener": 1}]},
        "consensus.graph.0: there is no robot 3 (got {speaker: 3, listener: 1, weight: 1.0}); "
        "allowed: two of the robots 1 to 2",
    ),
    "no spanning tree": (
        {
            "formation": {"shape": "line", "robots": 3, "side": 1.0},
            "robots.start": [[0, 0], [0, 1], [0, 2]],
            "consensus.delta": 1.0,
            "consensus.graph": [{"speaker": 1, "listener": 2}, {"speaker": 3, "listener": 2}],
        },
        "consensus.graph: no robot is heard, over others, by all, so they reach no consensus (Lemma 1); "
        "allowed: channels with a spanning tree from one robot to all while delta or delta_v is above 0",
    ),
    "a robot in a mapping that there is not": (
        {"robots.mass": {"3": 1.0}},
        "robots.mass.3: there is no robot 3; allowed: robots 1 to 2, or default",
    ),
}


@pytest.mark.parametrize(("changes", "fault"), FAULTY.values(), ids=FAULTY)
def test_faults(changes, fault):
    with pytest.raises(ScenarioError) as error:
        load_scenario("line", overrides=changes)
    assert [str(one).split(": ", 1)[1] for one in error.value.faults] == [fault]


def test_a_weight_below_zero_is_out_of_range():
    with pytest.raises(ScenarioError, match=r"consensus\.graph\.0\.weight: out of range \(got -1"):
        load_scenario("line", overrides={"consensus.graph": [{"speaker": 1, "listener": 2, "weight": -1}]})
