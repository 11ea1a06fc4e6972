import os
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_formation.scenario import (
    Scenario,
    ScenarioError,
    load_scenario,
    resolve,
    shipped_scenarios,
    with_overrides,
)
from drake_formation.scenario.overrides import apply
from drake_formation.scenario.source import parse
from drake_formation.scenario.validate import validate

TEXTS = {name: path.read_text(encoding="utf-8") for name, path in shipped_scenarios().items()}
GARBAGE = [
    "",
    "-1",
    "0",
    "1e999",
    ".nan",
    "null",
    "yes",
    "true",
    "[]",
    "{}",
    "[[1, 2], 3]",
    "'",
    "*a",
    "!x y",
    "&a [*a]",
]


def message_of(*args, **kwargs):
    with pytest.raises(ScenarioError) as error:
        load_scenario(*args, **kwargs)
    return str(error.value)


def test_shipped_scenarios_load_by_name():
    assert {"line", "quadrilateral", "octagon"} <= shipped_scenarios().keys()
    for name in shipped_scenarios():
        assert load_scenario(name).name == name


def test_a_file_wins_over_a_name_and_a_folder_does_not(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "octagon").mkdir()
    (tmp_path / "line").write_text(TEXTS["line"].replace("name: line", "name: mine"), encoding="utf-8")
    assert load_scenario("line").name == load_scenario(tmp_path / "line").name == "mine"
    assert load_scenario("octagon").name == "octagon"


def test_neither_a_file_nor_a_name(tmp_path):
    shipped = "lossy, octagon, quadrilateral, robot-failure"
    assert message_of("octagn").startswith("octagn: no such file or shipped scenario; allowed: a file, ")
    assert shipped in message_of("octagn")
    assert message_of("octagn").endswith("did you mean 'octagon'?")
    assert message_of(tmp_path).startswith(f"{tmp_path}: a folder, not a file")
    assert "no such file" in message_of("nowhere/at/all.yaml")
    assert "no such file" in message_of("") or "a folder" in message_of("")
    assert message_of("x" * 5000)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="the superuser may read everything")
def test_an_unreadable_file(tmp_path):
    path = tmp_path / "a.yaml"
    path.touch(mode=0)
    assert message_of(path) == f"{path}: cannot be read: Permission denied"


def test_overrides_are_validated_under_their_own_name():
    assert load_scenario("line", overrides={"springs.stiffness": 3e4}).springs.stiffness == 3e4
    assert load_scenario("line", overrides=["simulator.accuracy=1e-6"]).simulator.accuracy == 1e-6
    assert message_of("line", overrides=["consensus.delta=-1"]).startswith(
        "--set consensus.delta=-1: consensus.delta: out of range (got -1); allowed: a number >= 0"
    )
    assert message_of("line", overrides={"tracking.Q": 0}).startswith(
        "overrides['tracking.Q']: tracking.Q: a position costs nothing"
    )
    assert message_of("line", overrides=["spring.law=linear"]).endswith("did you mean 'springs'?")


def test_an_override_may_change_the_kind_of_a_union():
    overrides = [
        "formation={shape: polygon, robots: 3, side: 2}",
        "robots.start={centre: [0, 0]}",
        "springs.graph=[[1, 3]]",
    ]
    scenario = load_scenario("line", overrides=overrides)
    assert scenario.formation.shape == "polygon"
    assert scenario.springs.graph == ((1, 3),)


def test_variants_leave_the_original_alone():
    line = load_scenario("line")
    variant = with_overrides(line, {"consensus.delta": 1e4, "avoidance.obstacles.1.position": [20, 2]})
    assert (line.consensus.delta, variant.consensus.delta) == (0.0, 1e4)
    assert variant.avoidance.obstacles[1].position == (20.0, 2.0)
    assert with_overrides(variant, {"consensus.delta": 0.0, "avoidance.obstacles.1.position": [20, 1.9]}) == line
    with pytest.raises(ScenarioError, match=r"^overrides\['consensus.delta'\]: consensus.delta: out of range"):
        with_overrides(line, {"consensus.delta": -1})
    with pytest.raises(ScenarioError, match=r"^scenario 'line': robots\.start: 2 starting positions for 5 robots"):
        with_overrides(line, {"formation.robots": 5})


def test_a_variant_may_take_another_shape():
    variant = with_overrides(load_scenario("line"), {"formation": {"shape": "polygon", "robots": 2, "side": 1.0}})
    assert variant.formation.shape == "polygon"


def test_scenarios_built_in_python_are_checked_on_demand():
    line = load_scenario("line")
    resolve(line)
    broken = line.model_copy(update={"tracking": line.tracking.model_copy(update={"Q": 0.0})})
    with pytest.raises(ScenarioError, match=r"^scenario 'line': tracking\.Q: a position costs nothing"):
        resolve(broken)


def faults_of(text, overrides=None):
    """Faults of a text; none if it loads."""
    try:
        assert isinstance(validate(apply(parse(text, "f.yaml"), overrides)), Scenario)
    except ScenarioError as error:
        return error.faults or pytest.fail("an error without faults")
    return ()


@st.composite
def mutations(draw):
    """A shipped text with lines deleted, doubled, moved or indented, and values replaced by garbage."""
    lines = TEXTS[draw(st.sampled_from(sorted(TEXTS)))].splitlines()
    for _ in range(draw(st.integers(1, 4))):
        index = draw(st.integers(0, len(lines) - 1))
        line = lines[index]
        key = line.partition(":")[0]
        lines[index : index + 1] = draw(
            st.sampled_from(
                [
                    [],
                    [line, line],
                    ["  " + line],
                    [line[2:]],
                    [f"{key}: {draw(st.sampled_from(GARBAGE) | st.text(max_size=5))}"],
                    [f"{key}x: 1", line],
                    [re.sub(r"\d", draw(st.sampled_from("-9e. ")), line, count=1)],
                ]
            )
        )
        lines = lines or [""]
    return "\n".join(lines)


@settings(deadline=None, max_examples=500)
@given(mutations())
def test_a_mutilated_scenario_loads_or_every_fault_has_an_origin(text):
    for fault in faults_of(text):
        assert re.match(r"f\.yaml(:\d+)?$", fault.origin)
        assert len(str(fault).splitlines()) == 1


@settings(deadline=None, max_examples=300)
@given(
    st.lists(
        st.sampled_from(
            ["name", "formation", "robots", "start", "springs", "avoidance", "obstacles", "0", "Q", "x", "-1"]
        ),
        min_size=1,
        max_size=4,
    ),
    st.sampled_from(GARBAGE) | st.text(max_size=10),
)
def test_any_override_loads_or_its_fault_names_it_or_a_line(keys, value):
    faults = faults_of(TEXTS["line"], [f"{'.'.join(keys)}={value}"])
    assert all(fault.origin.startswith(("--set ", "f.yaml:")) for fault in faults)
    assert not faults or any(fault.origin.startswith("--set ") for fault in faults)
