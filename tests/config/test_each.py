"""One value for all, a list or a mapping hand out the same values."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.config.each import DEFAULT, Owners, is_list

values = st.lists(st.floats(0, 10), min_size=1, max_size=5)


@given(values)
def test_a_list_and_a_mapping_of_the_same_values_hand_out_the_same(values):
    owners = Owners.robots(len(values))
    mapping = dict(zip(owners.names, values, strict=True))
    for written in (values, tuple(values), mapping):
        assert not list(owners.faults(("f",), written, listed=False, required=True))
        assert [owners.value(written, i, False, None) for i in range(len(values))] == values


@given(values, st.integers(0, 4))
def test_default_counts_for_all_that_are_not_named(values, named):
    owners, named = Owners.robots(len(values)), named % len(values)
    written = {owners.names[named]: -1.0, DEFAULT: 5.0}
    found = [owners.value(written, i, False, None) for i in range(len(values))]
    assert found == [-1.0 if i == named else 5.0 for i in range(len(values))]
    unnamed = {owners.names[named]: -1.0}
    assert [owners.value(unnamed, i, False, 7.0) for i in range(len(values))].count(7.0) == len(values) - 1


def test_where_the_field_is_a_list_a_list_is_one_value_for_all():
    owners = Owners.robots(3)
    assert owners.value([1.0, 2.0], 2, True, None) == [1.0, 2.0]
    assert not list(owners.faults(("Q",), [1.0, 2.0], listed=True, required=True))
    assert is_list(tuple[float, ...])
    assert is_list(float | list[float])
    assert not is_list(float)


@pytest.mark.parametrize(
    ("written", "message", "allowed"),
    [
        ([1.0, 2.0], "2 values for 3 robots", "one for all, or 3, one a robot"),
        ({"4": 1.0, DEFAULT: 2.0}, "there is no robot 4", "robots 1 to 3, or default"),
        ({"1": 1.0}, "no value for robot 2", "also default: …"),
    ],
)
def test_faults_say_what_is_allowed(written, message, allowed):
    (fault,) = Owners.robots(3).faults(("mass",), written, listed=False, required=True)
    assert fault.message == message
    assert fault.allowed == allowed
    assert fault.path[0] == "mass"


def test_edges_go_by_their_names():
    owners = Owners.edges([(0, 1), (1, 2)])
    assert owners.names == ("1-2", "2-3")
    assert [owners.value({"2-3": 9.0}, i, False, 1.0) for i in range(2)] == [1.0, 9.0]
    (fault,) = owners.faults(("k",), [1.0], listed=False, required=False)
    assert fault.allowed == "one for all, or 2 in the order of the edges: 1-2, 2-3"


def test_a_slip_of_the_pen_is_guessed():
    (fault,) = Owners.robots(2).faults(("mass",), {"1": 1.0, "2": 1.0, "defualt": 2.0}, listed=False, required=True)
    assert fault.suggestion == DEFAULT
