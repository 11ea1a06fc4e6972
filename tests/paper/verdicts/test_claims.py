"""Claims decided by runs: the runs they name are those they are given."""

from drake_formation.paper.readings.two_readings import READINGS
from drake_formation.paper.verdicts.claims import CLAIMS, CLAIMS_BY_READING, claim_figures, claim_runs


class Missing(Exception):  # noqa: N818 - a signal of the test
    pass


def test_every_claim_takes_its_runs_from_those_it_declares():
    """Let no run be made: each claim asks for a declared one first, or for none."""
    results, figures = claim_runs(), claim_figures()

    class Declared:
        def __getitem__(self, scenario):
            assert scenario in results
            raise Missing

        def measured(self, scenario):
            assert scenario in figures
            raise Missing

    asked = 0
    for examine in CLAIMS:
        try:
            assert examine(Declared()).evidence
        except Missing:
            asked += 1
    assert asked == 3
    for examine in CLAIMS_BY_READING:
        for reading in READINGS.values():
            try:
                examine(reading, Declared())
            except Missing:
                asked += 1
    assert asked == 3 + len(READINGS) * len(CLAIMS_BY_READING)
