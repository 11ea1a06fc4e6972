"""Answers for people and for programs, and why a command ends."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.terminal import MANNER, report, stop


@pytest.fixture(autouse=True)
def _manner():
    MANNER.reset()
    yield
    MANNER.reset()


def test_a_message_is_all_that_is_said(capsys):
    with pytest.raises(SystemExit) as end:
        stop("why", 7)
    assert end.value.code == 7
    assert capsys.readouterr() == ("", "why\n")


def test_programs_are_told_what_is_wrong_as_one_document(capsys):
    MANNER.as_json = True
    with pytest.raises(SystemExit):
        stop("why", 7, [{"path": ("a", 0), "message": "why"}])
    out, err = capsys.readouterr()
    assert out == ""
    assert json.loads(err)["error"] == {
        "status": 7, "message": "why", "faults": [{"path": ["a", 0], "message": "why"}],
    }  # fmt: skip


def test_an_answer_is_for_people_or_for_programs_or_bare(capsys):
    report({"a": 1}, "one", "two", short="short")
    assert capsys.readouterr().out == "one\ntwo\n"
    MANNER.quiet = True
    report({"a": 1}, "one", short="short")
    assert capsys.readouterr().out == "short\n"
    report({"a": 1}, "one")
    assert capsys.readouterr().out == ""
    MANNER.as_json = True
    report({"a": 1}, "one")
    assert json.loads(capsys.readouterr().out) == {"a": 1}


values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.tuples(inner) | st.dictionaries(st.text(), inner),
)


@given(st.dictionaries(st.text(), values))
def test_what_programs_get_is_json_by_its_standard(document):
    from drake_formation.terminal.saying import _json

    def refuse(constant):
        raise AssertionError(constant)

    assert json.loads(_json(document), parse_constant=refuse).keys() == document.keys()
