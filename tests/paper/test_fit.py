"""The fit changes the avoidance gain and nothing else."""

from drake_formation import with_overrides
from drake_formation.paper.fit import BRACKET, tried
from drake_formation.paper.runs import transport


def test_a_try_changes_the_gain_alone():
    base = transport("line", "rubber", 0.0)
    assert with_overrides(tried(BRACKET[0]), {"avoidance.gain": base.avoidance.gain}) == base


def test_the_bracket_holds_the_gain_of_the_scenarios():
    assert BRACKET[0] < transport("line", "rubber", 0.0).avoidance.gain < BRACKET[1]
