"""The fit changes the avoidance gain and nothing else."""

import pytest

from drake_formation import with_overrides
from drake_formation.paper.readings.fit import BRACKET, CASE, fit, tried
from drake_formation.paper.readings.simulated import SIMULATED
from drake_formation.paper.readings.two_readings import PRINTED, PROBABLE


@pytest.mark.parametrize(("settings", "reading"), [(None, PRINTED), (SIMULATED["line"], PROBABLE)])
def test_a_try_changes_the_gain_alone(settings, reading):
    base = reading.transport(*CASE)
    assert with_overrides(tried(settings, BRACKET[0]), {"avoidance.gain": base.avoidance.gain}) == base
    assert BRACKET[0] < base.avoidance.gain < BRACKET[1]


@pytest.mark.slow
@pytest.mark.parametrize("settings", [None, SIMULATED["line"]])
def test_the_fit_finds_the_gain_of_the_scenarios(settings):
    found = fit(settings)
    assert found.gain == pytest.approx(found.used, rel=0.01)
    assert found.error == pytest.approx(found.target, abs=1e-5)
