"""Readings beside the two: each differs from the probable one in what it says."""

from dataclasses import fields

from drake_formation.paper.readings import variants
from drake_formation.paper.readings.fit import Fit
from drake_formation.paper.readings.simulated import SIMULATED
from drake_formation.paper.readings.two_readings import PRINTED, PROBABLE
from drake_formation.paper.readings.variants import LAWS, RANGES, alternatives, by, in_range, ingredients
from drake_formation.paper.runs import CASES
from drake_formation.scenario import with_overrides


def test_every_ingredient_is_left_out_of_the_same_reading():
    named = {name.partition(":")[0] for name in ingredients()}
    assert {"a", "b", "c", "d", "e", PRINTED.title, PROBABLE.title} <= named
    for name, variant in ingredients().items():
        same = all(variant.run(*case) == PROBABLE.transport(*case) for case in CASES)
        assert same == (name == PROBABLE.title or (variant.largest and "printed" not in name)), name


def test_the_settings_give_the_probable_reading():
    assert all(by(SIMULATED)(*case) == PROBABLE.transport(*case) for case in CASES)


def test_in_range_differs_from_as_printed_in_the_sensing_alone():
    case = ("line", "rubber", 0.0)
    assert with_overrides(in_range(*case), {"avoidance.sensing": "nearest"}) == PRINTED.transport(*case)


def test_alternatives_differ_in_law_width_and_gathering_and_are_fitted(monkeypatch):
    monkeypatch.setattr(variants, "fit", lambda _line: Fit(gain=7.0, used=1, range=1, error=1, target=1, runs=1))
    alternatives.cache_clear()
    try:
        found = alternatives()
    finally:
        alternatives.cache_clear()
    assert len(found) == len(LAWS) * (len(RANGES) + 1)
    for settings in found.values():
        for name, its in settings.items():
            assert its.gain == 7.0
            differing = {f.name for f in fields(its) if getattr(its, f.name) != getattr(SIMULATED[name], f.name)}
            assert differing <= {"law", "range", "gain", "gathering_gain", "duration"}
