"""Claims decided by runs: the runs they name are those they are given."""

from drake_formation.paper.claims import CLAIMS, claim_runs


class Missing(Exception):  # noqa: N818 - a signal of the test
    pass


def test_every_claim_takes_its_runs_from_those_it_declares():
    """Let no run be made: each claim asks for a declared one first, or for none."""
    declared = claim_runs()

    class Declared:
        def __getitem__(self, scenario):
            assert scenario in declared
            raise Missing

    asked = 0
    for examine in CLAIMS:
        try:
            assert examine(Declared()).evidence
        except Missing:
            asked += 1
    assert asked == 8
