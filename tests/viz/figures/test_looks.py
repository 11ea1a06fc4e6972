"""Robots are told apart: by all eyes, and in print without colour."""

from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest
from made_up_run import made_up_run
from matplotlib.colors import to_rgb

from drake_formation.viz.figures import robot_colours, robot_looks
from drake_formation.viz.figures.looks import COLOURS, look
from drake_formation.viz.style import SHEET, own_style

EYES = {
    "all colours": np.eye(3),
    "no red cones": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "no green cones": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]],
    "no blue cones": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.3039]],
}
"""What linear red, green and blue become (Machado, Oliveira & Fernandes 2009, severity 1)."""
JUST_SEEN = 2.3
"""The least difference of two colours that an eye sees (CIE 1976)."""


def linear(colour):
    shares = np.array(to_rgb(colour))
    return np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)


def lab(light):
    """CIE 1976 L*a*b* of linear sRGB."""
    to_xyz = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
    x, y, z = np.cbrt(np.maximum(to_xyz @ light / np.array([0.95047, 1.0, 1.08883]), 1e-9))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def least_difference(colours, eye):
    seen = [lab(np.clip(EYES[eye] @ linear(colour), 0.0, 1.0)) for colour in colours]
    return min(np.linalg.norm(one - other) for one, other in combinations(seen, 2))


@pytest.mark.parametrize("eye", EYES)
def test_all_eyes_tell_the_eight_robots_of_the_octagon_apart(eye):
    assert least_difference(COLOURS, eye) > 6 * JUST_SEEN


def test_not_all_colours_would_do():
    assert least_difference(mpl.color_sequences["tab10"][:8], "no red cones") < 6 * JUST_SEEN


def test_without_colour_the_eight_are_told_apart_by_dashes_and_by_markers():
    looks = list(robot_looks(made_up_run()).values())
    assert len({its.dashes for its in looks}) == len({its.marker for its in looks}) == 8


def test_a_robot_has_one_colour_for_good():
    few, many = robot_colours(made_up_run(3)), robot_colours(made_up_run(30))
    assert all(many[robot] == colour for robot, colour in few.items())
    assert len(set(many.values())) == 30
    assert len({(look(n).colour, look(n).dashes) for n in range(1, 65)}) == 64


def test_the_sheet_has_the_same_colours_and_is_used_as_pyplot_uses_one():
    with own_style():
        own = mpl.rcParams["axes.prop_cycle"].by_key()["color"]
    with mpl.style.context(SHEET):
        assert mpl.rcParams["axes.prop_cycle"].by_key()["color"] == own
        assert mpl.rcParams["font.size"] == 8
    assert [f"#{colour.removeprefix('#')}" for colour in own] == list(COLOURS)
