import math
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.config.errors import Fault, ScenarioError, nearest, shown


def test_a_fault_says_everything_on_one_line():
    fault = Fault(("springs", "stifness"), "unknown key", "3", "stiffness, damping", "stiffness", "line.yaml:7")
    assert str(fault) == (
        "line.yaml:7: springs.stifness: unknown key (got 3); allowed: stiffness, damping; did you mean 'stiffness'?"
    )


def test_a_fault_omits_what_it_does_not_know():
    assert str(Fault((), "empty", origin="a.yaml")) == "a.yaml: empty"
    assert str(Fault(("robots", "start", 0), "too few entries")) == "robots.start.0: too few entries"


@given(st.text(), st.text(), st.text())
def test_a_fault_never_takes_two_lines(key, message, value):
    assert len(str(Fault((key,), message, shown(value))).splitlines()) <= 1


def test_an_error_lists_every_fault_and_survives_pickling():
    error = ScenarioError([Fault(("a",), "missing"), Fault(("b",), "unknown key")])
    assert str(error).splitlines() == ["a: missing", "b: unknown key"]
    assert pickle.loads(pickle.dumps(error)).faults == error.faults


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "null"),
        (True, "true"),
        (1.0, "1.0"),
        (math.nan, ".nan"),
        (-math.inf, "-.inf"),
        ("complete", "complete"),
        ("true", '"true"'),
        ("3", '"3"'),
        ("", '""'),
        ([1, [2.5, "x"]], "[1, [2.5, x]]"),
        ({"seed": 8}, "{seed: 8}"),
        pytest.param(10**5000, "an integer of 16610 bits", id="huge"),
    ],
)
def test_values_are_shown_as_in_yaml(value, text):
    assert shown(value) == text


def test_long_values_are_cut():
    assert len(shown(list(range(1000)))) == 60


def test_the_nearest_name_is_only_given_when_it_is_near():
    assert nearest("stifness", ["stiffness", "damping"]) == "stiffness"
    assert nearest("colour", ["stiffness", "damping"]) == ""
    assert nearest(3, ["stiffness"]) == ""
