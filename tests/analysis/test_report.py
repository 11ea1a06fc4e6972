"""The terminal report says what the certificate holds."""

import io
import re

import pytest
from rich.console import Console
from unstable import UNSTABLE

from drake_formation import load_scenario
from drake_formation.analysis import Questions, certify
from drake_formation.analysis.report import MOST_ROWS, report


def printed(name, questions=None, width=130, **overrides):
    text = io.StringIO()
    found = certify(load_scenario(name, overrides=overrides), questions=questions)
    Console(width=width, file=text).print(report(found))
    return " ".join(text.getvalue().split())


def test_a_stable_loop_is_called_stable_with_its_slowest_motion():
    text = printed("line", **{"springs.stiffness": 3e4, "consensus.delta": 1e4})
    assert "stable: yes." in text
    assert "(centre, rotation, stretch) decays at 0.1125 1/s" in text
    assert "after 34.77 s" in text
    assert "Consensus cannot move: centre." in text
    assert "(0, inf) 65.8°" in text
    assert "leave the rotation to consensus" in text
    assert "younger than 0.9 ms" in text
    assert "Not covered" in text


def test_an_unstable_loop_is_called_unstable_with_what_to_try():
    text = printed("line", **UNSTABLE)
    assert "stable: no." in text
    assert "rotation grows at 0.5153 1/s" in text
    assert "--set consensus.delta_v=" in text
    assert "never" in text
    assert "No answer" in text


@pytest.mark.parametrize(
    ("channel", "said"),
    [
        ({"kind": "packets", "profile": "factory"}, "over its channels: unstable. In the mean over what is lost,"),
        ({"kind": "delay", "delay": 8e-4}, "over its channels: stable. Every motion decays"),
        (
            {"kind": "packets", "profile": "lossy"},
            "over its channels: not certified. Delays differ from packet to packet",
        ),
    ],
)
def test_channels_have_a_verdict_and_the_rest_is_said_to_be_for_wires(channel, said):
    text = printed("line", **{"springs.stiffness": 3e4, "consensus.delta": 1e4, "consensus.channel": channel})
    assert said in text
    assert "over wires, stable: yes." in text
    assert "All that follows is for the same formation with wires for channels." in text
    assert "channels: all but the verdict" in text


def test_what_rounding_hides_is_said():
    assert "stable: cannot be told." in printed("line", **{"consensus.delta_v": 1e9})


def test_a_request_out_of_reach_is_answered_in_words():
    text = printed("line", questions=Questions(decay_rate=0.2))
    assert "For a decay rate 0.2 1/s: no δ does" in text


def test_a_force_limit_out_of_reach_is_answered_in_words():
    assert "Largest δ under the force limit: none," in printed("line", questions=Questions(force_limit=1e-9))


def test_the_papers_law_is_told_from_real_springs():
    assert "also resists a rotation, with 60000 N/m" in printed(
        "line", **{"springs.law": "linear", "springs.stiffness": 3e4}
    )


def test_many_modes_are_summed_up_by_kind():
    text = printed(
        "octagon",
        **{
            "formation": {"shape": "polygon", "robots": 12, "side": 1.0},
            "robots": {"start": {"centre": [0, 0]}, "mass": [float(mass) for mass in range(30, 42)]},
        },
    )
    count = re.search(r"stretch, (\d+) modes", text)
    assert count is not None
    assert int(count[1]) > MOST_ROWS


def test_what_channels_hold_by_distances_is_said():
    text = printed("quadrilateral", **{"consensus.graph": "cycle"})
    assert "Over the channels: 4 distances of rank 4, 1 change of shape free." in text
    assert "Along the object's springs: 6 distances of rank 5, rigid, 1 more than needed" in text
    assert "Robots compare distances" not in text


@pytest.mark.parametrize("width", [60, 100])
def test_a_narrow_terminal_gets_the_whole_verdict(width):
    assert "after 34.77 s" in printed("line", width=width)
