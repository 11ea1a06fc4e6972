import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.config.errors import ScenarioError
from drake_formation.scenario.source import parse, read


def faults_of(text):
    with pytest.raises(ScenarioError) as error:
        parse(text, "f.yaml")
    return [str(fault) for fault in error.value.faults]


def test_scalars_follow_yaml_1_2():
    text = "a: yes\nb: 1e4\nc: 0o10\nd: 010\ne: 12:30\nf: 2020-01-01\ng: ~\nh: true\ni: -.inf\nj: +0x1F\nk: '3'"
    data = parse(text, "f.yaml").data
    assert data == {
        "a": "yes",
        "b": 1e4,
        "c": 8,
        "d": 10,
        "e": "12:30",
        "f": "2020-01-01",
        "g": None,
        "h": True,
        "i": float("-inf"),
        "j": 31,
        "k": "3",
    }
    assert isinstance(data["b"], float)


def test_a_directive_does_not_bring_back_yaml_1_1():
    assert parse("%YAML 1.1\n---\na: yes\n", "f.yaml").data == {"a": "yes"}


def test_every_value_knows_its_line():
    document = parse("a:\n  b:\n    - 1\n    - c: 2\n", "f.yaml")
    assert document.origin(("a",)) == "f.yaml:1"
    assert document.origin(("a", "b")) == "f.yaml:2"
    assert document.origin(("a", "b", 1, "c")) == "f.yaml:4"
    assert document.origin(("a", "b", 1, "missing")) == "f.yaml:4"
    assert document.origin(("missing",)) == "f.yaml:1"


def test_aliases_are_copied_in():
    assert parse("a: &x [1, 2]\nb: *x\n", "f.yaml").data == {"a": [1, 2], "b": [1, 2]}


def test_all_duplicate_keys_are_reported_with_both_lines():
    assert faults_of("a: 1\nb: {c: 1,\n  c: 2}\na: 3\na: 4\n") == [
        "f.yaml:3: b.c: given twice, first on line 2",
        "f.yaml:4: a: given twice, first on line 1",
        "f.yaml:5: a: given twice, first on line 1",
    ]


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("", "f.yaml: empty; allowed: a scenario (a YAML mapping)"),
        ("# only a comment\n", "f.yaml: empty; allowed: a scenario (a YAML mapping)"),
        ("- a\n", "f.yaml:1: not a mapping (got [a]); allowed: a scenario (a YAML mapping)"),
        ("1.5: a\n", "f.yaml:1: a key that is not text (got 1.5)"),
        ("a: 1\n[b]: 2\n", "f.yaml:2: a key that is not text"),
        ("a:\n  b: !!python/object:os.system x\n", "f.yaml:2: a.b: tag tag:yaml.org,2002:python/object:os.system"),
        ("a: !mine {b: 1}\n", "f.yaml:1: a: tag !mine is not allowed"),
        ("a: !!int x\n", "f.yaml:1: a: not a valid int (got x)"),
        ("a: " + "9" * 5000, "f.yaml:1: a: not a valid int"),
        ("a: &x\n  - *x\n", "f.yaml:1: a.0: an alias that contains itself"),
        ("a: *x\n", "f.yaml:1: not valid YAML: found undefined alias 'x'"),
        ("a: 1\nb: [1\n", "f.yaml:3: not valid YAML: while parsing a flow sequence"),
        ("a: 1\n---\nb: 2\n", "f.yaml:2: not valid YAML: expected a single document"),
        ("a: \0\n", "f.yaml:1: not valid YAML: unacceptable character"),
        ('a: "\\Uffffffff"\n', "f.yaml:1: not valid YAML"),
        ("a: " + "[" * 2000, "f.yaml:1: nested too deeply"),
    ],
)
def test_faulty_text(text, fault):
    (found,) = faults_of(text)
    assert found.startswith(fault)


def test_aliases_cannot_multiply_without_end():
    levels = [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 9)]
    assert faults_of("\n".join(["a0: &a0 [1]", *levels])) == ["f.yaml:1: not valid YAML: more than 300000 values"]


@given(st.text(alphabet=st.sampled_from("ab:-[]{}&*!|>'\"%#?@,\\ \n\tx0.~<=\x85\ufeff1")))
def test_any_text_is_data_or_a_scenario_error(text):
    try:
        data, faults = parse(text, "f.yaml").data, ()
    except ScenarioError as error:
        data, faults = {}, error.faults
    assert isinstance(data, dict)
    assert all(fault.origin.startswith("f.yaml") for fault in faults)


def test_a_byte_order_mark_is_ignored(tmp_path):
    path = tmp_path / "a.yaml"
    path.write_bytes(b"\xef\xbb\xbfa: 1\n")
    assert read(path).data == {"a": 1}


def test_files_that_are_no_text(tmp_path):
    binary = tmp_path / "binary.yaml"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScenarioError, match=r"binary\.yaml: not UTF-8 text"):
        read(binary)
    with pytest.raises(ScenarioError, match=r"missing\.yaml: cannot be read: No such file"):
        read(tmp_path / "missing.yaml")
    with pytest.raises(ScenarioError, match="cannot be read: Is a directory"):
        read(tmp_path)


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ("a: &a {x: 1, y: {z: 2}}\nb:\n  x: 3\n  <<: *a", {"x": 3, "y": {"z": 2}}),
        ("a: &a {x: 1}\nc: &c {x: 5, w: 2}\nb: {<<: [*a, *c], q: 1}", {"q": 1, "x": 1, "w": 2}),
        ("a: &a {x: 1, v: 4}\nc: &c {<<: *a, y: 2}\nb: {<<: *c, x: 9}", {"x": 9, "y": 2, "v": 4}),
        ('b: {"<<": 1}', {"<<": 1}),
    ],
)
def test_a_merge_key_brings_what_a_mapping_does_not_give_itself(text, data):
    assert parse(text, "f.yaml").data["b"] == data


def test_a_merged_value_knows_the_line_of_its_base():
    document = parse("a: &a\n  x: 1\n  y: 2\nb:\n  <<: *a\n  x: 3\n", "f.yaml")
    assert document.origin(("b", "y")) == "f.yaml:3"
    assert document.origin(("b", "x")) == "f.yaml:6"


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("b:\n  <<: 3", "f.yaml:2: b.<<: merges what is not a mapping; allowed: a mapping, or a list of them"),
        ("b:\n  <<: [{}, x]", "f.yaml:2: b.<<: merges what is not a mapping; allowed: a mapping, or a list of them"),
        ("b: &b\n  c:\n    <<: *b", "f.yaml:3: b.c.<<: an alias that contains itself"),
        (
            "a: &a {}\nb:\n  <<: *a\n  <<: *a",
            "f.yaml:4: b.<<: given twice, first on line 3; allowed: a list of mappings",
        ),
        ("a: &a {x: 1}\nb: {<<: *a, x: 2, x: 3}", "f.yaml:2: b.x: given twice, first on line 2"),
    ],
)
def test_a_merge_key_that_cannot_be_is_refused(text, fault):
    assert faults_of(text) == [fault]


def test_merges_that_multiply_without_end_are_refused():
    lines = ["a0: &a0 {x: 1}", *(f"a{k}: &a{k} {{<<: [*a{k - 1}, *a{k - 1}]}}" for k in range(1, 40))]
    assert faults_of("\n".join(lines)) == ["f.yaml:1: not valid YAML: more than 300000 merges"]
