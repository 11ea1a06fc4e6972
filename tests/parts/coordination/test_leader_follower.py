"""Followers keep their places beside the robots they hear; who follows whom, and how they move."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm
from strategies import graphs

from drake_formation import ScenarioError, build_diagram, load_scenario, simulate
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.formation.links import Channels
from drake_formation.parameters import set_parameters
from drake_formation.parts.coordination.leader_follower import Follower, predecessors
from drake_formation.parts.tracking.lqr import lqr_gain, robot_matrices
from drake_formation.scenario import resolve, warnings

LEADS = {"kind": {1: "lqr", "default": "none"}}


def scenario(graph="complete", **given):
    changes = {"consensus": {"kind": "leader_follower", "graph": graph}, "tracking": LEADS, "aggregation.duration": 0.0}
    return load_scenario("quadrilateral", overrides={**changes, "transport.duration": 3.0, **given})


def tree(graph, leader=0):
    return predecessors(resolve(scenario(graph)).channels, leader)


def test_who_follows_whom():
    assert tree("complete") == {1: 0, 2: 0, 3: 0}
    assert tree("path") == {1: 0, 2: 1, 3: 2}
    assert tree("cycle") == {1: 0, 3: 0, 2: 1}
    assert tree("path", leader=2) == {1: 2, 3: 2, 0: 1}


def test_followers_hear_along_the_channels_and_not_against_them():
    one_way = Channels.of(3, [(1, 0, 1.0), (2, 1, 0.0)])
    assert predecessors(one_way, 0) == {1: 0, 2: 1}
    assert predecessors(one_way, 2) == {}


@given(st.integers(2, 8).flatmap(lambda n: st.tuples(st.just(n), graphs(n, connected=True), st.integers(0, n - 1))))
def test_every_robot_follows_one_that_it_hears_and_in_the_end_the_leader(case):
    robots, edges, leader = case
    heard = [(i - 1, j - 1, 1.0) for edge in edges for i, j in (edge, edge[::-1])]
    following = predecessors(Channels.of(robots, heard), leader)
    assert set(following) == set(range(robots)) - {leader}
    assert all((robot, followed, 1.0) in heard for robot, followed in following.items())
    for robot in range(robots):
        seen = []
        while robot != leader:  # a circle would have no end
            assert robot not in seen
            seen.append(robot)
            robot = following[robot]  # noqa: PLW2901


def test_a_follower_in_its_place_exerts_nothing_and_beside_it_the_papers_gain():
    block = Follower(2, lqr_gain(40.0, np.eye(4), np.eye(2)), [1.0, -2.0])
    context = block.CreateDefaultContext()
    block.GetInputPort("channel_2").FixValue(context, [5.0, 6.0, 0.1, 0.2])
    for offset, force in (([0, 0, 0, 0], [0, 0]), ([0.5, 0, 0, 2.0], [-0.5, -18.0])):
        block.GetInputPort("state").FixValue(context, np.add([6.0, 4.0, 0.1, 0.2], offset))
        np.testing.assert_allclose(block.GetOutputPort("force").Eval(context), force, atol=1e-9)


def test_a_chain_moves_as_its_cascade_of_linear_systems():
    """Without an object each robot is driven by its predecessor alone: the loop is block triangular."""
    chain = scenario("path", **{"springs.stiffness": 0.0, "avoidance": {"obstacles": []}})
    formation = resolve(chain)
    a, b = robot_matrices(40.0)
    bk = b @ lqr_gain(40.0, np.eye(4), np.eye(2))
    loop = np.kron(np.eye(4), a - bk) + np.kron(np.eye(4, k=-1), bk)
    deviation = np.hstack([formation.starts - formation.slots - formation.goal, np.zeros((4, 2))]).ravel()
    expected = (expm(3.0 * loop) @ deviation).reshape(4, 4)[:, :2] + formation.slots + formation.goal
    result = simulate(chain, engine="blocks")
    np.testing.assert_allclose(result["position"][-1], expected, atol=1e-5)
    assert not result["consensus_force"].sel(robot=1).any()
    assert not result["tracking_force"].sel(robot=[2, 3, 4]).any()


@pytest.mark.slow
@pytest.mark.parametrize("graph", ["complete", "path"])
def test_engines_agree(graph):
    ends = [simulate(scenario(graph), engine=engine)["position"][-1] for engine in ("blocks", "compiled")]
    np.testing.assert_allclose(*ends, atol=1e-5)


def faults(**given):
    with pytest.raises(ScenarioError) as caught:
        scenario(**given)
    return [str(fault) for fault in caught.value.faults]


def test_a_follower_that_hears_nobody_who_follows_is_refused_with_the_channels_that_would_do():
    (found,) = faults(graph=[[1, 2], {"speaker": 2, "listener": 3}, {"speaker": 4, "listener": 3}])
    assert "robot 4 hears neither its leader, robot 1, nor who follows it" in found
    assert "allowed: a channel to robot 4 from one of: 1, 2, 3" in found


def test_wrong_leaders_and_weights_are_refused_in_their_places():
    (found,) = faults(**{"consensus.leader": 5})
    assert "consensus.leader: there is no robot 5" in found
    (found,) = faults(**{"consensus.leader": 0})
    assert "consensus.leader: out of range" in found
    (found,) = faults(**{"consensus.R": 0.0})
    assert "consensus.R: not positive definite" in found


def test_who_tracks_is_asked_about():
    assert not warnings(scenario())
    (both,) = warnings(scenario(tracking={"kind": "lqr"}))
    assert "a follower tracks the reference too" in str(both)
    (nobody,) = warnings(scenario(tracking={"kind": "none"}))
    assert "robot 1 leads and tracks no reference" in str(nobody)


def test_another_leader_needs_another_diagram():
    diagram = build_diagram(scenario("path"))
    context = diagram.CreateDefaultContext()
    set_parameters(diagram, context, scenario("path", **{"consensus.Q": 4.0}))
    led_by_two = {"consensus.leader": 2, "tracking": {"kind": {2: "lqr", "default": "none"}}}
    with pytest.raises(ValueError, match="another structure"):
        set_parameters(diagram, context, scenario("path", **led_by_two))


def test_it_is_not_certified():
    with pytest.raises(IllPosedError, match="robot 1 coordinates by 'leader_follower'"):
        linearize(scenario())
