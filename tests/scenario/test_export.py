import jsonschema
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_formation.scenario import Scenario, dump_scenario, json_schema, load_scenario, shipped_scenarios, to_yaml
from drake_formation.scenario.source import parse, read


@settings(deadline=None, max_examples=300)
@given(st.from_type(Scenario))
def test_yaml_brings_back_an_equal_scenario(scenario):
    assert Scenario.model_validate(parse(to_yaml(scenario), "f.yaml").data) == scenario


@pytest.mark.parametrize(
    "text", ["", "yes", "null", "1e4", "a: b # c", "a\nb\n", "\x85", "\u2028x", " ", "\ufeff", "'", "\0"]
)
def test_any_description_comes_back(text):
    scenario = load_scenario("line", overrides={"description": text})
    assert parse(to_yaml(scenario), "f.yaml").data["description"] == text


@pytest.mark.parametrize("name", shipped_scenarios())
def test_a_dumped_scenario_loads_again(name, tmp_path):
    scenario = load_scenario(name)
    dump_scenario(scenario, tmp_path / "a.yaml")
    assert load_scenario(tmp_path / "a.yaml") == scenario


def test_the_dump_is_pleasant_to_read():
    text = to_yaml(load_scenario("line", overrides={"springs.stiffness": 3e4, "description": "m² of µ"}))
    assert "  stiffness: 30000.0\n" in text
    assert "  start: [[4.0, 5.0], [1.0, 2.0]]\n" in text
    assert "  - position: [6.0, 5.05]\n    radius: 0.0\n" in text
    assert "description: m² of µ\n" in text
    assert text.index("name:") < text.index("formation:") < text.index("simulator:")


def test_every_default_is_spelled_out():
    data = parse(to_yaml(load_scenario("line")), "f.yaml").data
    assert data.keys() == Scenario.model_fields.keys()
    assert data["simulator"].keys() == Scenario.model_fields["simulator"].annotation.model_fields.keys()


def test_the_schema_is_one():
    jsonschema.Draft202012Validator.check_schema(json_schema())
    assert json_schema()["title"] == "drake_formation scenario"


@pytest.mark.parametrize("name", shipped_scenarios())
def test_the_schema_accepts_the_shipped_scenarios(name):
    jsonschema.validate(read(shipped_scenarios()[name]).data, json_schema())
    jsonschema.validate(parse(to_yaml(load_scenario(name)), "f.yaml").data, json_schema())


@pytest.mark.parametrize("change", [{"springz": {}}, {"springs": {"stiffness": -1}}, {"consensus": {"graph": "ring"}}])
def test_the_schema_rejects_what_loading_rejects(change):
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate(read(shipped_scenarios()["line"]).data | change, json_schema())


@pytest.mark.parametrize("kind", [None, "point_mass", "omnidirectional", "unicycle", ["unicycle", "point_mass"]])
def test_the_schema_goes_by_the_kind_and_takes_the_default_where_there_is_none(kind):
    data = read(shipped_scenarios()["line"]).data
    changed = data | {"robots": data["robots"] | ({"kind": kind} if kind else {})}
    jsonschema.validate(changed, json_schema())
    changed["robots"]["ahead"] = 0.2
    if kind not in ("unicycle", ["unicycle", "point_mass"]):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(changed, json_schema())


def test_every_field_explains_itself():
    schema = json_schema()
    sections = {"Scenario": schema, **schema["$defs"]}
    for name, section in sections.items():
        assert section.get("description"), name
        for key, field in section["properties"].items():
            referred = schema["$defs"].get(field.get("$ref", "").rpartition("/")[2], {})
            assert field.get("description") or referred.get("description"), f"{name}.{key}"
