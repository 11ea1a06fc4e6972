"""A claim of the paper and what became of it."""

from dataclasses import dataclass

HOLDS, CONDITION, FAILS = "holds", "holds with a condition", "does not hold"
VACUOUS = "vacuous"
"""True, of numbers that could not have shown otherwise."""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A claim and what became of it.

    Attributes:
        claim: what the paper says, in our words.
        verdict: ``HOLDS``, ``CONDITION``, ``FAILS`` or ``VACUOUS``.
        evidence: the number that decides, and the condition.
        source: the run or matrix it came from.
        reading: by which reading of the paper, where that matters.
    """

    claim: str
    verdict: str
    evidence: str
    source: str
    reading: str = ""


def verdict(mostly: bool, entirely: bool) -> str:
    """Holds if it does entirely, with a condition if it does mostly."""
    return (HOLDS if entirely else CONDITION) if mostly else FAILS
