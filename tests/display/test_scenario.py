"""A scenario in a notebook: pictures of it, and a table of what is not as by default."""

from shown import Shown

from drake_formation import load_scenario, with_overrides
from drake_formation.display.scenario import not_default
from drake_formation.scenario import Scenario

ATTACK = '<script>alert(1)</script><img src=x onerror="alert(2)">'


def test_the_table_has_what_is_not_as_by_default_and_only_that():
    line = load_scenario("line")
    given = {path: value for path, value, _ in not_default(with_overrides(line, {"consensus.delta_v": 12.5}))}
    assert given["consensus.delta_v"] == "12.5"
    assert given["transport.goal"] == "[25, 3.5]"
    assert given["avoidance.obstacles"] == "[{position: [6, 5.05]}, {position: [20, 1.9]}]"
    assert "springs.stiffness" not in given  # 1.45, the default
    assert not any(path.startswith(("simulator", "actuator")) for path in given)
    assert "consensus.delta_v" not in {path for path, _, _ in not_default(line)}


def test_parts_of_other_kinds_and_values_of_single_robots_are_listed():
    overrides = {"consensus.channel.kind": "packets", "consensus.channel.loss": 0.1, "robots.mass": {"1": 50.0}}
    overrides |= {"robots.mass": {"1": 50.0, "default": 40.0}, "avoidance.line_of_sight": True}
    rows = {path: (value, meaning) for path, value, meaning in not_default(load_scenario("line", overrides=overrides))}
    assert rows["consensus.channel.kind"][0] == "packets"
    assert rows["consensus.channel.loss"] == ("0.1", "share of packets that are lost (1)")
    assert rows["robots.mass"][0] == "{1: 50, default: 40}"
    assert rows["avoidance.line_of_sight"][0] == "true"


def test_pictures_show_robots_links_goals_and_obstacles():
    shown = Shown(load_scenario("octagon")._repr_html_())
    assert shown.count("svg") == 2
    assert shown.count("polyline", stroke="#009e73") == 28  # both ways, one line
    assert shown.count("circle", stroke="#0072b2") == 8  # starts
    assert shown.count("polyline", stroke="#d55e00") == 16  # crosses
    assert shown.count("circle", fill="#555") == 2
    assert {"1", "8"} <= set(shown.texts)


def test_what_a_user_wrote_is_text(tmp_path):
    scenario = load_scenario("line")
    scenario = scenario.model_copy(update={"name": ATTACK, "description": ATTACK})
    shown = Shown(scenario._repr_html_())
    assert not shown.runs
    assert shown.count("img") == 0
    assert shown.text.count(ATTACK) == 2


def test_one_that_is_wrong_says_what_is():
    plain = load_scenario("line").model_dump() | {"formation": {"shape": "polygon", "robots": 5, "side": 1.0}}
    shown = Shown(Scenario.model_validate(plain)._repr_html_())
    assert "robots.start" in shown.text
    assert shown.count("svg") == 0
