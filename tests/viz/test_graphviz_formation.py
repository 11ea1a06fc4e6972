"""A formation at a glance has a line for whatever is wired, and robots where their slots are."""

import re
import xml.etree.ElementTree as ET
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from carrying import carried
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_formation.diagram import build_diagram, wired
from drake_formation.scenario import load_scenario, resolve, shipped_scenarios
from drake_formation.viz.graphviz import diagram_dot
from drake_formation.viz.graphviz_formation import Line, formation_dot, lines_of, write_formation
from drake_formation.viz.rendering import svg

DIAGRAMS = Path(__file__).parents[2] / "diagrams"
NODE = re.compile(r'^"robot_(\d+)" \[.*pos="(\S+),(\S+)"\]$', re.M)
LINE = re.compile(r'^"robot_(\d+)" -> "robot_(\d+)" \[.*dir=(\w+).*tooltip="(spring|channel) .*pos="(.*)"\]$', re.M)

pairs = [[i, j] for i in range(1, 5) for j in range(1, 5) if i < j]


def square(springs, channels):
    """Four robots; springs as pairs, channels as pairs or as one way."""
    one_way = [{"speaker": i, "listener": j} for i, j in channels]
    overrides = {"springs.graph": springs, "consensus.graph": one_way, "consensus.delta": 0.0}
    return resolve(load_scenario("quadrilateral", overrides=overrides))


@given(
    st.lists(st.sampled_from(pairs), unique_by=tuple, max_size=6),
    st.lists(st.sampled_from([*pairs, *(pair[::-1] for pair in pairs)]), unique_by=tuple, max_size=12),
)
@settings(max_examples=10, deadline=None)
def test_every_wire_between_robots_is_in_one_line(springs, channels):
    found = lines_of(wired(square(springs, channels)), 4)
    said = {(line.start + 1, line.end + 1) for line in found if line.kind == "channel"}
    said |= {(b, a) for a, b in said if Line("channel", a - 1, b - 1, True) not in found}
    assert said == set(map(tuple, channels))
    assert sorted((line.start + 1, line.end + 1) for line in found if line.kind == "spring") == sorted(
        map(tuple, springs)
    )
    assert len(found) == len(set(found))


@pytest.mark.parametrize("name", ["line", "octagon"])
def test_robots_are_where_their_slots_are(name):
    formation = resolve(load_scenario(name))
    places = np.array([[float(x), float(y)] for _, x, y in NODE.findall(formation_dot(formation))])
    drawn, slots = places - places.mean(axis=0), formation.slots - formation.slots.mean(axis=0)
    scale = np.linalg.norm(drawn) / np.linalg.norm(slots)
    np.testing.assert_allclose(drawn, scale * slots, atol=0.01)


def test_springs_and_channels_of_a_pair_lie_side_by_side():
    lines = LINE.findall(formation_dot(resolve(load_scenario("octagon"))))
    assert Counter((kind, way) for _, _, way, kind, _ in lines) == {("spring", "none"): 28, ("channel", "none"): 28}
    begins = {(a, b, kind): np.array(curve.split()[0].split(","), float) for a, b, _, kind, curve in lines}
    for a, b, kind in list(begins):
        apart = np.linalg.norm(begins[a, b, "spring"] - begins[a, b, "channel"])
        assert apart > 3.0, (a, b, kind)


def test_a_channel_one_way_has_a_head_at_the_robot_that_hears():
    (line,) = LINE.findall(formation_dot(square([], [[2, 3]])))
    assert line[:4] == ("2", "3", "forward", "channel")
    assert line[4].startswith("e,")


@pytest.mark.parametrize("robots", [1, 2, 30])
def test_any_number_of_robots_is_drawn_and_no_two_of_them_touch(robots):
    scenario = load_scenario(
        "octagon",
        overrides={"formation": {"shape": "polygon", "robots": robots, "side": 1.0}}
        if robots > 2
        else {"formation": {"shape": "line", "robots": robots, "side": 1.0}},
    )
    dot = formation_dot(resolve(scenario))
    places = np.array([[float(x), float(y)] for _, x, y in NODE.findall(dot)])
    assert len(places) == robots
    size = 72 * float(re.search(r"shape=circle, fixedsize=true, width=([\d.]+)", dot)[1])
    apart = np.linalg.norm(places[:, None] - places, axis=-1) + 1e9 * np.eye(robots)
    assert apart.min() > 1.5 * size


def test_the_text_is_the_same_each_time_and_names_what_is_carried(tmp_path):
    formation = resolve(carried("{kind: rigid}"))
    assert formation_dot(formation) == formation_dot(resolve(carried("{kind: rigid}")))
    write_formation(formation, tmp_path / "carried.svg")
    assert "object: rigid, held by every robot" in words((tmp_path / "carried.svg").read_text())


def words(picture):
    """What is written in an SVG, and what shows under the mouse."""
    found = Counter()
    for element in ET.fromstring(picture).iter():
        found[(element.text or "").strip()] += 1
        found[element.get("{http://www.w3.org/1999/xlink}title", "")] += 1
    return found


@pytest.mark.parametrize("name", sorted({path.stem for path in DIAGRAMS.glob("*.svg")} & set(shipped_scenarios())))
def test_the_pictures_of_shipped_scenarios_are_current(name):
    assert words((DIAGRAMS / f"{name}.svg").read_text()) == words(svg(diagram_dot(build_diagram(load_scenario(name)))))


def test_the_picture_of_the_octagon_at_a_glance_is_current():
    drawn = svg(formation_dot(resolve(load_scenario("octagon"))))
    assert words((DIAGRAMS / "octagon-formation.svg").read_text()) == words(drawn)
