"""Numbers of the README that no other test computes."""

import re
import tomllib
from pathlib import Path

import pytest

from drake_formation import ScenarioError, build_diagram, load_scenario
from drake_formation.analysis import delay_margin, linearize, velocity_gain
from drake_formation.formation.rigidity import rigid_rank
from drake_formation.paper.published import published
from drake_formation.parts.channels.profiles import PROFILES
from drake_formation.scenario import json_schema
from drake_formation.terminal import FAILED_RUN, WRONG_INPUT
from drake_formation.viz.graphviz import diagram_dot

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_versions_are_those_of_the_project():
    assert PROJECT["requires-python"] == ">=3.11"
    assert PROJECT["license"] == "BSD-3-Clause"
    oldest = next(line for line in PROJECT["dependencies"] if line.startswith("drake>="))
    assert oldest.removeprefix("drake>=").startswith("1.51")


def test_depths_of_the_diagram():
    line = build_diagram(load_scenario("line"))
    first, second = (diagram_dot(line, depth=depth) for depth in (1, 2))
    boxes = {f"<B>{name}</B>" for name in ("plant", "tracking", "consensus", "avoidance")}
    assert "<B>robot_1</B>" in first
    assert not any(box in first for box in boxes)
    assert all(box in second for box in boxes)


def test_exit_statuses():
    assert (WRONG_INPUT, FAILED_RUN) == (2, 3)


def test_a_body_has_three_or_four_wheels():
    def with_wheels(angles):
        return load_scenario("line", overrides={"robots.kind": "omnidirectional", "robots.wheel_angles": angles})

    with_wheels([90.0, 210.0, 330.0])
    with_wheels([45.0, 135.0, 225.0, 315.0])
    with pytest.raises(ScenarioError):
        with_wheels([0.0, 180.0])


def test_the_table_of_networks_is_that_of_the_code():
    rows = dict(re.findall(r"^\| `(\w+)` \| (\d.*) \|$", README, re.MULTILINE))
    for name, network in PROFILES.items():
        if network.period:
            numbers = re.findall(r"[\d.]+(?:e-\d+)?", rows[name])
            spread = [network.spread * 1e3] if network.spread else []
            loss = network.loss if "e" in numbers[-1] else network.loss * 100
            said = [network.period * 1e3, network.delay * 1e3, *spread, loss]
            assert list(map(float, numbers)) == pytest.approx(said), name
            assert ("bursts of five" in rows[name]) == (network.burst == 5.0)


def test_defaults_are_as_said():
    sections = json_schema()["$defs"]
    assert sections["SpringsObject"]["properties"]["look_every"]["default"] == 1e-3
    assert sections["Failure"]["properties"]["brake_time"]["default"] == 0.05


def test_the_shared_medium_is_as_said():
    consensus = load_scenario("shared-medium").consensus
    assert consensus.medium.kind == "csma"
    assert (consensus.channel.period, consensus.channel.bits) == (1 / 50, 256)


def test_damping_makes_the_delays_that_it_says():
    loop = linearize(load_scenario("line", overrides={"consensus.delta": 1e4}))
    gain = velocity_gain(loop, damping_ratio=0.7).delta_v
    late = [delay_margin(loop, of=of, delta_v=gain).delay_s for of in ("neighbour", "relative")]
    assert [round(delay * 1e3) for delay in late] == [86, 33]


@pytest.mark.parametrize(("robots", "rigid", "tree"), [(4, 10, 6), (8, 26, 14)])
def test_rigid_formations_take_as_many_channels_as_said(robots, rigid, tree):
    assert rigid_rank(robots) == 2 * robots - 3
    assert 2 * rigid_rank(robots) == rigid
    assert 2 * (robots - 1) == tree


def test_what_the_paper_finds_of_channels():
    assert published()["quadrilateral"]["topologies"]["channels"] == [12, 10, 8, 6]
