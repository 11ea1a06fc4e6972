import numpy as np
import pytest

from drake_formation.config.errors import ScenarioError
from drake_formation.scenario.overrides import apply
from drake_formation.scenario.schema import Line, Polygon
from drake_formation.scenario.source import parse

TEXT = """\
name: a
springs:
  stiffness: 1.45
avoidance:
  obstacles:
    - position: [6, 5]
    - position: [20, 1.9]
"""


def applied(overrides):
    return apply(parse(TEXT, "f.yaml"), overrides)


def faults_of(overrides):
    with pytest.raises(ScenarioError) as error:
        applied(overrides)
    return [str(fault) for fault in error.value.faults]


def test_from_python_and_from_the_command_line_alike():
    assert applied({"springs.stiffness": 3e4}).data["springs"] == {"stiffness": 3e4}
    assert applied(["springs.stiffness=3e4"]).data["springs"] == {"stiffness": 3e4}
    assert applied("springs.stiffness=3e4").data["springs"] == {"stiffness": 3e4}
    assert applied(None).data == applied({}).data == parse(TEXT, "f.yaml").data


def test_the_original_stays_as_it_is():
    document = parse(TEXT, "f.yaml")
    apply(document, {"avoidance.obstacles.0.position": [0, 0]})
    assert document == parse(TEXT, "f.yaml")


def test_values_are_yaml_1_2():
    data = applied(["a=yes", "b=[1, 2e1]", "c={shape: line}", "d=''", "e=x=y"]).data
    assert [data[key] for key in "abcde"] == ["yes", [1, 20.0], {"shape": "line"}, "", "x=y"]


def test_numpy_and_models_become_plain_values():
    overrides = {"a": np.arange(2), "b": np.float64(0.5), "c": Line(shape="line", robots=2, side=1.0), "d": (1, 2)}
    data = applied(overrides).data
    assert data["a"] == [0, 1]
    assert type(data["b"]) is float
    assert data["c"] == {"shape": "line", "robots": 2, "side": 1.0}
    assert data["d"] == [1, 2]


def test_lists_are_entered_by_position():
    data = applied({"avoidance.obstacles.1.position": [7, 8], "avoidance.obstacles.0.position.0": 9}).data
    assert data["avoidance"]["obstacles"] == [{"position": [9, 5]}, {"position": [7, 8]}]


def test_sections_left_at_their_defaults_are_made():
    document = applied(["consensus.delta=1e4", "x.y.z=1"])
    assert document.data["consensus"] == {"delta": 1e4}
    assert document.data["x"] == {"y": {"z": 1}}
    assert document.origin(("consensus", "graph")) == "--set consensus.delta=1e4"


def test_later_overrides_go_into_earlier_ones_but_not_into_the_callers_value():
    shape = {"shape": "polygon", "robots": 4}
    document = applied({"formation": shape, "formation.side": 2.0})
    assert document.data["formation"] == {"shape": "polygon", "robots": 4, "side": 2.0}
    assert shape == {"shape": "polygon", "robots": 4}
    assert document.origin(("formation", "robots")) == "overrides['formation']"
    assert document.origin(("formation", "side")) == "overrides['formation.side']"


def test_a_model_replaces_a_whole_union():
    data = applied({"formation": Polygon(shape="polygon", robots=3, side=1.0)}).data
    assert data["formation"] == {"shape": "polygon", "robots": 3, "side": 1.0}


def test_an_override_takes_over_the_origin_of_all_that_it_replaces():
    document = applied(["avoidance.obstacles=[{position: [1, 2]}]"])
    origin = "--set avoidance.obstacles=[{position: [1, 2]}]"
    assert document.origin(("avoidance", "obstacles", 0, "position")) == origin
    assert document.origin(("avoidance",)) == "f.yaml:4"


def test_all_faults_are_found_at_once():
    assert faults_of(["robots.mass", "robots.mass=", "name=]", "springs.stiffness.x=1"]) == [
        "--set robots.mass: no value; allowed: PATH=VALUE, such as springs.stiffness=3e4",
        "--set robots.mass=: no value; allowed: PATH=VALUE, such as springs.stiffness=3e4",
        "--set name=]: not valid YAML: while parsing a block node, expected the node content, but found ']'",
        "--set springs.stiffness.x=1: springs.stiffness.x: springs.stiffness has no parts (got 1.45)",
    ]


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("a..b=1", "a..b: not a dotted path"),
        ("=1", "not a dotted path"),
        ("springs.damping.x=1", "springs.damping.x: springs.damping has no parts (got 0.0)"),
        ("avoidance.obstacles.9.radius=1", "obstacles.9: no such position in the list (got 9); allowed: 0 to 1"),
        ("avoidance.obstacles.-1=1", "avoidance.obstacles.-1: no such position in the list"),
        ("avoidance.obstacles.first=1", "avoidance.obstacles.first: no such position in the list"),
        ("avoidance.obstacles." + "9" * 5000 + "=1", "no such position in the list"),
    ],
)
def test_paths_that_lead_nowhere(override, message):
    (fault,) = faults_of([override])
    assert fault.startswith("--set ")
    assert message in fault


def test_an_empty_default_list_has_no_positions():
    with pytest.raises(ScenarioError, match=r"obstacles\.0: .*allowed: none, the list is empty"):
        apply(parse("name: a", "f.yaml"), ["avoidance.obstacles.0.radius=1"])


def test_one_path_twice_is_a_fault():
    assert faults_of(["name=a", "name=b"]) == ["--set name=b: name: given twice"]
