"""A virtual structure follows the reference, and waits for a robot that stays behind."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import metres, speeds

from drake_formation import ScenarioError, load_scenario, simulate
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.parts.coordination.virtual_structure import structure_acceleration
from drake_formation.scenario import resolve, warnings

motions = st.tuples(metres, metres, speeds, speeds)
AXES = (metres, metres, speeds, speeds, speeds, speeds)
gains = st.tuples(*[st.floats(0, 10, allow_subnormal=False)] * 5)


@given(st.tuples(*AXES), gains, st.lists(st.floats(0, 2), max_size=3))
def test_on_the_reference_with_all_in_place_it_moves_as_the_reference(reference, gains, weights):
    copy, place = reference[:4], reference[:2]
    heard = [(*copy, weight) for weight in weights]
    assert structure_acceleration(copy, reference, place, heard, gains) == reference[4:]


@given(motions, st.tuples(*AXES), st.tuples(metres, metres), st.lists(motions, max_size=3), gains)
def test_feedback_brakes_by_the_error_and_does_nothing_else(copy, reference, seen, others, gains):
    heard = [(*motion, 0.5) for motion in others]
    fed = structure_acceleration(copy, reference, seen, heard, gains)
    blind = structure_acceleration(copy, reference, seen, heard, (*gains[:4], 0.0))
    squares = [np.sum(np.subtract(place[:2], copy[:2]) ** 2) for place in (seen, *others)]
    error = squares[0] + 0.5 * sum(squares[1:])
    np.testing.assert_allclose(np.subtract(fed, blind), -gains[4] * error * np.array(copy[2:]), rtol=1e-6, atol=1e-6)


@given(motions, motions, gains)
def test_copies_that_see_each_other_draw_each_other_alike(one, other, gains):
    """Each robot on its copy: what one is drawn by, the other is drawn back by, beside goal and feedback."""
    gains = (0.0, 0.0, *gains[2:4], 0.0)
    there = structure_acceleration(one, (0.0,) * 6, one[:2], [(*other, 1.0)], gains)
    back = structure_acceleration(other, (0.0,) * 6, other[:2], [(*one, 1.0)], gains)
    np.testing.assert_allclose(there, np.negative(back), rtol=1e-12, atol=1e-12)


def scenario(**given):
    changes = {
        "aggregation.duration": 0.0,
        "robots.start": {"centre": [1.6875, 3.5125]},
        "tracking": {"kind": "none"},
        "consensus": {"kind": "virtual_structure"},
        "avoidance": {"obstacles": []},
        "transport.duration": 6.0,
    }
    return load_scenario("quadrilateral", overrides=changes | given)


@pytest.mark.parametrize("graph", ["complete", "path"])
def test_without_disturbances_every_robot_follows_the_reference_in_its_slot(graph):
    moving = scenario(**{"transport.reference": {"kind": "minimum_jerk"}, "consensus.graph": graph})
    result = simulate(moving, engine="blocks")
    share = result["time"].values / 6.0
    course = 10 * share**3 - 15 * share**4 + 6 * share**5
    centre = np.array([1.6875, 3.5125]) + course[:, None] * [25.0, 0.0]
    np.testing.assert_allclose(result["position"], centre[:, None] + resolve(moving).slots, atol=1e-5)
    np.testing.assert_allclose(result["tracking_error"], 0.0, atol=1e-5)


def test_to_a_set_point_it_moves_as_the_papers_lqr():
    """Its default gains are those of m s̈ = −K_l [s; ṡ] at 40 kg: 1/40 1/s² and 9/40 1/s."""
    structure = simulate(scenario(), engine="blocks")
    local = {"tracking": {"kind": "lqr"}, "consensus": {"delta": 0.0}}
    np.testing.assert_allclose(
        structure["position"], simulate(scenario(**local), engine="blocks")["position"], atol=1e-4
    )


def progress(graph, **gains):
    """How far four robots abreast have come (m) while an obstacle dead ahead holds robot 2 back."""
    abreast = {"formation": {"shape": "line", "robots": 4, "side": 1.0, "heading": 90.0}}
    ahead = resolve(scenario(**abreast)).starts[1] + [2.0, 0.0]
    held = scenario(**abreast, **{
        "springs.stiffness": 0.0,
        "consensus": {"kind": "virtual_structure", "graph": graph, "k_feedback": 10.0, **gains},
        "avoidance": {"range": 0.9, "gain": 300.0, "obstacles": [{"position": ahead.tolist()}]},
        "transport.duration": 10.0,
    })  # fmt: skip
    position = simulate(held, engine="blocks")["position"].values[..., 0]
    return position[-1] - position[0]


def test_it_waits_for_a_robot_that_is_held_back():
    blind = progress("complete", k_sync=0.0, d_sync=0.0, k_feedback=0.0)
    waiting = progress("complete")
    assert blind[1] < 2.0  # it cannot pass
    assert min(blind[[0, 2, 3]]) > 8.0  # and the others leave it behind
    assert max(waiting) < 2.5
    feedback_alone = progress("complete", k_sync=0.0, d_sync=0.0)
    assert max(feedback_alone) < min(blind[[0, 2, 3]]) / 2


def test_who_does_not_hear_the_robot_held_back_is_told_by_the_others():
    """On a path 1-2-3-4 robot 4 hears 3 alone, which waits for 2."""
    assert progress("path")[3] < progress("path", k_sync=0.0, d_sync=0.0, k_feedback=0.0)[3] / 2


@pytest.mark.slow
def test_engines_agree_from_starts_out_of_formation():
    gathering = scenario(**{"robots.start": [[0.8, 5.1], [0.25, 2.45], [2.6, 2.0], [3.1, 4.5]],
                            "aggregation.duration": 1.0, "transport.duration": 2.0})  # fmt: skip
    ends = [simulate(gathering, engine=engine)["position"][-1] for engine in ("blocks", "compiled")]
    np.testing.assert_allclose(*ends, atol=1e-5)


def test_what_is_wrong_or_may_not_be_meant_is_told():
    with pytest.raises(ScenarioError, match=r"consensus\.Q: a diagonal of 2 entries"):
        scenario(**{"consensus.Q": [1.0, 1.0]})
    with pytest.raises(ScenarioError, match=r"consensus\.k_goal: out of range"):
        scenario(**{"consensus.k_goal": 0.0})
    assert not warnings(scenario())
    (both,) = warnings(scenario(tracking={"kind": "lqr"}))
    assert "tracking.kind: a robot in a virtual structure tracks the reference too" in str(both)


def test_it_is_not_certified():
    with pytest.raises(IllPosedError, match="robot 1 coordinates by 'virtual_structure'"):
        linearize(scenario())
