"""Every number of the README has a claim, and every claim a test that exists or a command that measures it."""

import ast
from pathlib import Path

import pytest
from building.claims import load_claims, numbers_of, one_space, positions_of

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
CLAIMS = load_claims(ROOT)


@pytest.mark.parametrize("claim", CLAIMS, ids=lambda claim: claim.says[:40])
def test_a_claim_stands_in_the_readme_and_has_what_makes_it_true(claim):
    assert one_space(claim.says) in one_space(README)
    assert bool(claim.test) != bool(claim.measured)
    if claim.test:
        file, _, name = claim.test.partition("::")
        tree = ast.parse((ROOT / file).read_text(encoding="utf-8"))
        assert name in {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
    else:
        assert claim.measured.split()[0] in {"drake-formation", "make"}


def test_every_number_has_a_claim():
    covered = positions_of(README, CLAIMS)
    missing = [words for _, position, words in numbers_of(README) if position not in covered]
    assert not missing, "docs/claims.yaml needs a line for:\n" + "\n".join(missing)


@pytest.mark.parametrize("text", ["it takes 7 ms", "in 1.5e-3 s, `code 3`", "| cell | 12 % |"])
def test_a_new_number_is_found(text):
    assert len(numbers_of(text)) == 1


@pytest.mark.parametrize(
    "text", ["(Eq. 2)", "Eqs. 4-7", "`a 3`", "```sh\nrun 3\n```", "Figures 1-23", "(Gilbert 1960)"]
)
def test_numbers_that_state_nothing_are_not(text):
    assert not numbers_of(text)
