"""Readings that are as good."""

import pytest

from drake_formation.measuring import Metrics
from drake_formation.paper.readings import rivals, variants
from drake_formation.paper.readings.fit import Fit


@pytest.fixture
def unfitted(monkeypatch):
    """The alternatives without the runs that fit them."""
    monkeypatch.setattr(variants, "fit", lambda _line: Fit(gain=7.0, used=1, range=1, error=1, target=1, runs=1))
    variants.alternatives.cache_clear()
    yield
    variants.alternatives.cache_clear()


def test_choices_that_the_paper_does_not_give_are_counted(unfitted):
    one_law = rivals.free_choices(("lines for every N", 8.0, 0.0))
    assert one_law == len(rivals.FREE)
    assert rivals.free_choices(("lines for every N", 8.0, 5.0)) == one_law + 1
    assert rivals.free_choices(("lines for N > 2", 8.0, 5.0)) == one_law + 2


def test_what_tells_readings_apart_comes_first(unfitted, monkeypatch):
    monkeypatch.setattr(rivals, "rise", lambda _store, settings: settings["line"].range)

    class Wide:
        """The wider the field, the less clearance; all else is the same."""

        def measured(self, scenario):
            return Metrics(
                stacked_tracking_error_m=1.0,
                min_clearance_m=1 / scenario.avoidance.range**2,
                turned_m=1.0,
                rms_force_n=1.0,
                energy_j=1.0,
            )

    keys = [("lines for every N", width, 5.0) for width in (4.0, 12.0)]
    first, second, *rest = rivals._apart(Wide(), keys).splitlines()[2:]
    assert first.startswith("| least clearance (m)")
    assert first.endswith("| 9.00 |")
    assert second.startswith("| rise of ‖ε_i‖ (s)")
    assert all(line.endswith("| 1.00 |") for line in rest)
