"""What the README claims, and the test of each claim."""

import re
from dataclasses import dataclass
from pathlib import Path

from ruamel.yaml import YAML

from drake_formation.markdown import markdown_table

INTRODUCTION = """# Claims

Every number that the README states, with what makes it true: a test that fails where it is wrong or, for what takes
minutes and for times (which no test asserts), the command that measures it. A number in the README that no line here
covers fails a test. The README's tables of laws and of the paper's Table 5 have tests of their own.
"""


@dataclass(frozen=True)
class Claim:
    """A statement of the README.

    Attributes:
        says: the words of the README.
        test: ``tests/FILE.py::NAME`` of the test that would fail; or
        measured: the command that measures it, where it takes minutes or is a time.
    """

    says: str
    test: str = ""
    measured: str = ""


def load_claims(root: Path) -> list[Claim]:
    """The claims in ``docs/claims.yaml``."""
    return [Claim(**entry) for entry in YAML(typ="safe").load(root / "docs" / "claims.yaml")]


def claims_page(root: Path) -> str:
    """The claims as a table."""
    rows = [(_shown(claim.says), _maker(claim)) for claim in load_claims(root)]
    return INTRODUCTION + "\n" + markdown_table(("the README says", "made true by"), rows) + "\n"


def _shown(says: str) -> str:
    return "<br>".join(line.strip("| ").replace(" | ", ", ") for line in says.splitlines())


def _maker(claim: Claim) -> str:
    file, _, name = claim.test.partition("::")
    return f"[`{name}`](../{file}#{name})" if claim.test else f"`{claim.measured}`"


def one_space(text: str) -> str:
    """A text with all white space as one space."""
    return re.sub(r"\s+", " ", text)


CODE = re.compile(r"^```.*?^```$|`(?:[^`\n]|\n(?!\n))*`", re.DOTALL | re.MULTILINE)
MARKED = re.compile(r"<!-- (\w+) -->.*?<!-- /\1 -->", re.DOTALL)
CITED = re.compile(
    r"\]\([^)]*\)"  # where a link leads
    r"|\b(?:Eqs?|Figs?|Sec|Tables?|Figures?|notebooks|ISO|IEEE|TS|Engineering\s+Journal)\.?\s+[\d.()]+"
    r"(?:(?:-|\s+to\s+|,\s+|\s+and\s+)\d+)*"
    r"|\b(?:19|20)\d\d\b"  # years
    r"|\bH2\b|\b3GPP\b"
)
NUMBER = re.compile(r"(?<![\w.])\d+(?:[.,]\d+)*(?:e[-+]?\d+)?")


def numbers_of(readme: str) -> list[tuple[str, int, str]]:
    """The numbers that a README states in prose and in tables written by hand: each with its place, and words about it.

    Left out are code, tables between marks (tests of their own compare them with what made them), and numbers of
    equations, figures, standards and years.
    """
    for pattern in (MARKED, CODE, CITED):
        readme = pattern.sub(lambda match: " " * len(match[0]), readme)
    return [
        (match[0], match.start(), one_space(readme[max(0, match.start() - 60) : match.end() + 40]))
        for match in NUMBER.finditer(readme)
    ]


def positions_of(readme: str, claims: list[Claim]) -> set[int]:
    """Where in a README the words of any claim stand."""
    covered: set[int] = set()
    for claim in claims:
        words = r"\s+".join(map(re.escape, claim.says.split()))
        for match in re.finditer(words, readme):
            covered.update(range(*match.span()))
    return covered
