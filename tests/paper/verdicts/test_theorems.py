"""Claims that need no run are decided on the matrices of the actual diagrams."""

import pytest

from drake_formation.paper.store import Store
from drake_formation.paper.verdicts import theorems
from drake_formation.paper.verdicts.verdict import CONDITION, FAILS, HOLDS, verdict


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        (theorems.gain, HOLDS),
        (theorems.theorem_1, HOLDS),
        (theorems.theorem_2, CONDITION),
        (theorems.lemmas, HOLDS),
        (theorems.lemma_2, CONDITION),
    ],
)
def test_verdicts_on_matrices(claim, verdict):
    found = claim(None)
    assert found.verdict == verdict
    assert found.evidence
    assert found.source


def test_the_mean_of_moving_robots_moves(tmp_path):
    found = theorems.invariant_mean(Store(tmp_path))
    assert found.verdict == FAILS
    assert "x̄ moves by 1.00 m in 10 s" in found.evidence


def test_theorem_2_leaves_the_motion_of_the_whole_formation_alone():
    printed = theorems._formation_matrix(local=False)
    assert sum(abs(printed) < theorems.MARGIN) == 4
    assert theorems._formation_matrix(local=True).real.max() == pytest.approx(-9 / 80, abs=1e-6)


def test_a_claim_holds_entirely_mostly_or_not():
    assert verdict(mostly=True, entirely=True) == HOLDS
    assert verdict(mostly=True, entirely=False) == CONDITION
    assert verdict(mostly=False, entirely=False) == FAILS
