"""Claims that need no run are decided on the matrices of the actual diagrams."""

import pytest

from drake_formation.paper import claims
from drake_formation.paper.claims import CONDITION, HOLDS


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        (claims.gain, HOLDS),
        (claims.theorem_1, HOLDS),
        (claims.theorem_2, CONDITION),
        (claims.lemmas, HOLDS),
        (claims.lemma_2, CONDITION),
    ],
)
def test_verdicts_on_matrices(claim, verdict):
    found = claim(None)
    assert found.verdict == verdict
    assert found.evidence
    assert found.source


def test_theorem_2_leaves_the_motion_of_the_whole_formation_alone():
    printed = claims._formation_matrix(local=False)
    assert sum(abs(printed) < claims.MARGIN) == 4
    assert claims._formation_matrix(local=True).real.max() == pytest.approx(-9 / 80, abs=1e-6)
