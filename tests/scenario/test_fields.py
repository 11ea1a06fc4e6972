from typing import Annotated, Any

import pytest

from drake_formation.config.values import CostMatrix, Graph, Positive
from drake_formation.parts import kinds
from drake_formation.scenario.fields import chooser, locate, names, phrase
from drake_formation.scenario.schema import (
    Line,
    RandomStart,
    Scenario,
    Shape,
    Slots,
)
from drake_formation.scenario.written import PartOf

Reference = Annotated[Any, PartOf("reference")]


@pytest.mark.parametrize(
    ("loc", "path"),
    [
        (("formation", "line", "side"), ("formation", "side")),
        (("formation", "slots", "slots", 1, 0), ("formation", "slots", 1, 0)),
        (("robots", "point_mass", "start", "random", "random", "seed"), ("robots", "start", "random", "seed")),
        (("robots", "point_mass", "start", "positions", 0), ("robots", "start", 0)),
        (("robots", "point_mass", "mass", "list", 1), ("robots", "mass", 1)),
        (("robots", "point_mass", "mass", "mapping", "2"), ("robots", "mass", "2")),
        (("tracking", "lqr", "Q", "scalar", "matrix", 1, 2), ("tracking", "Q", 1, 2)),
        (("consensus", "consensus", "graph", "named"), ("consensus", "graph")),
        (("springs", "hookean", "graph", "edges", 0, 1), ("springs", "graph", 0, 1)),
        (("transport", "reference", "waypoints", "points", 1, 0), ("transport", "reference", "points", 1, 0)),
        (("transport", "reference", "potential_field", "known", "listed", 1), ("transport", "reference", "known", 1)),
    ],
)
def test_branches_of_unions_are_not_part_of_the_path(loc, path):
    assert locate(loc).path == path


def test_a_place_knows_its_section_and_its_field():
    place = locate(("formation", "line", "side"))
    assert place.section is Line
    assert place.allowed == "a number > 0 and <= 1000000 — distance between neighbours (m)"
    assert locate(("formation", "slots", "slots")).section is Slots


def test_a_union_is_described_as_a_whole():
    assert (
        locate(("consensus", "consensus", "graph", "named")).annotation
        == locate(("consensus", "consensus", "graph")).annotation
    )


def test_an_unknown_key_has_a_section_but_no_annotation():
    place = locate(("formation", "line", "sides"))
    assert (place.section, place.annotation) == (Line, None)


def test_phrases():
    assert phrase(Positive) == "a number > 0"
    assert phrase(bool) == "true or false"
    assert phrase(RandomStart) == "a mapping {random}"
    assert phrase(Graph) == "complete, cycle, path, star or a list, each a list of 2, each a whole number"
    assert phrase(CostMatrix) == "a number or a list, each a number or a list, each a list, each a number"
    assert phrase(Slots.model_fields["slots"].annotation).startswith("a list, each a list of 2")


def test_names_are_those_a_value_may_choose_from():
    assert names(Graph) == ["complete", "cycle", "path", "star"]
    assert names(Scenario.model_fields["formation"].annotation) == ["line", "polygon", "grid", "slots"]
    assert names(Positive) == []
    assert names(Annotated[Any, PartOf("coordination")]) == list(kinds("coordination"))  # not also its laws
    assert names(Reference) == ["set_point", "minimum_jerk", "potential_field", "waypoints"]


def test_a_key_chooses_between_sections():
    assert (chooser(Shape), chooser(Reference)) == ("shape", "kind")
