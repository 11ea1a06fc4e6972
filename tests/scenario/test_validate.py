import pytest

from drake_formation.config.errors import ScenarioError
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate

TEXT = """\
name: test
formation:
  shape: line
  robots: 2
  side: 1.0
robots:
  start: [[4, 5], [1, 2]]
transport:
  goal: [25, 3.5]
"""


def faults_of(old="", new="", more=""):
    assert old in TEXT
    with pytest.raises(ScenarioError) as error:
        validate(parse(TEXT.replace(old, new, 1) + more, "f.yaml"))
    return [str(fault) for fault in error.value.faults]


def test_a_scenario_needs_no_more_than_this():
    assert validate(parse(TEXT, "f.yaml")).robots.mass == 40.0


@pytest.mark.parametrize(
    ("old", "new", "more", "fault"),
    [
        ("side:", "sied:", "", "f.yaml:5: formation.sied: unknown key; allowed: shape, robots, side, heading; did"),
        ("", "", "spring: {}", "f.yaml:10: spring: unknown key; allowed: name, description, formation"),
        ("  side: 1.0\n", "", "", "f.yaml:2: formation.side: missing; allowed: a number > 0 and <= 1000000 — distance"),
        ("name: test\n", "", "", "f.yaml:1: name: missing; allowed: text — short name"),
        (
            "shape: line",
            "shape: lines",
            "",
            "f.yaml:3: formation.shape: unknown name (got lines); allowed: line, polygon, grid, slots",
        ),
        ("  shape: line\n", "", "", "f.yaml:2: formation.shape: missing; allowed: line, polygon, grid, slots"),
        ("shape: line", "shape: [1]", "", "f.yaml:3: formation.shape: unknown name (got [1])"),
        (
            "robots: 2",
            "robots: 2.0",
            "",
            "f.yaml:4: formation.robots: not allowed (got 2.0); allowed: a whole number >= 1",
        ),
        ("robots: 2", "robots: true", "", "f.yaml:4: formation.robots: not allowed (got true)"),
        ("robots: 2", "robots: 1000000000", "", "f.yaml:4: formation.robots: out of range (got 1000000000)"),
        ("side: 1.0", "side: '1.0'", "", 'f.yaml:5: formation.side: not allowed (got "1.0"); allowed: a number > 0'),
        ("side: 1.0", "side: .nan", "", "f.yaml:5: formation.side: not finite (got .nan)"),
        ("side: 1.0", "side: -1", "", "f.yaml:5: formation.side: out of range (got -1)"),
        ("[1, 2]", "[1]", "", "f.yaml:7: robots.start.1: too few entries (got [1]); allowed: a list of 2"),
        ("[1, 2]", "[1, 2, 3]", "", "f.yaml:7: robots.start.1: too many entries (got [1, 2, 3])"),
        ("[1, 2]", "3", "", "f.yaml:7: robots.start.1: not allowed (got 3)"),
        ("[[4, 5], [1, 2]]", "[]", "", "f.yaml:7: robots.start: too few entries (got [])"),
        (
            "[[4, 5], [1, 2]]",
            "{random: {seed: 1, about: [0, 0], spread: -1}}",
            "",
            "f.yaml:7: robots.start.random.spread: out of range (got -1)",
        ),
        ("[[4, 5], [1, 2]]", "{center: [0, 0]}", "", "f.yaml:7: robots.start.centre: missing"),
        (
            "[[4, 5], [1, 2]]",
            "here",
            "",
            "f.yaml:7: robots.start: not allowed (got here); allowed: a list of at least 1, each a list of 2",
        ),
        (
            "",
            "",
            "springs:\n",
            "f.yaml:10: springs: not allowed (got null); allowed: a mapping {law, graph, stiffness, damping, ",
        ),
        (
            "",
            "",
            "springs:\n  stiffness: [1, -1]",
            "f.yaml:11: springs.stiffness.1: out of range (got -1); allowed: a number >= 0 — k_ij (N/m)",
        ),
        ("", "", "springs: {law: hook}", "f.yaml:10: springs.law: unknown name (got hook); allowed: hookean, linear"),
        (
            "",
            "",
            "consensus: {graph: compleet}",
            "f.yaml:10: consensus.graph: unknown name (got compleet); allowed: complete, cycle, path, star or a list",
        ),
        (
            "",
            "",
            "consensus: {graph: [[1, a]]}",
            "f.yaml:10: consensus.graph.0.1: not allowed (got a); allowed: a whole number",
        ),
        ("", "", "tracking: {Q: [[1, a]]}", "f.yaml:10: tracking.Q.0.1: not allowed (got a)"),
        (
            "",
            "",
            "simulator: {use_error_control: yes}",
            "f.yaml:10: simulator.use_error_control: not allowed (got yes); allowed: true or false",
        ),
        (
            "",
            "",
            "avoidance:\n  obstacles:\n    - [6, 5]",
            "f.yaml:12: avoidance.obstacles.0: not allowed (got [6, 5]); allowed: a mapping {position, radius, ",
        ),
        ("name: test", "name: ../test", "", 'f.yaml:1: name: not a valid name (got "../test")'),
    ],
)
def test_faults_of_single_fields(old, new, more, fault):
    assert any(found.startswith(fault) for found in faults_of(old, new, more)), faults_of(old, new, more)


def test_misspelled_and_missing_are_both_told_once():
    assert len(faults_of("side:", "sied:")) == 2
    assert len(faults_of("[1, 2]", "3")) == 1


def test_faults_between_fields_have_their_lines_too():
    (fault,) = faults_of("robots: 2", "robots: 3")
    assert fault.startswith("f.yaml:7: robots.start: 2 starting positions for 3 robots")
