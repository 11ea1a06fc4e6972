"""What the README claims, and the test of each claim."""

import re
from dataclasses import dataclass
from pathlib import Path

from ruamel.yaml import YAML

from drake_formation.markdown import markdown_table

INTRODUCTION = """# Claims

Every number that the README states about what this project does, with what makes it true: a test that computes it, or,
for times, the benchmark that measures it (no test asserts a time). A number in the README that no line here covers is an
error.
"""


@dataclass(frozen=True)
class Claim:
    """A statement of the README.

    Attributes:
        says: the words of the README, spaces as one.
        test: ``tests/file.py::name`` of the test that would fail, or a file that measures it.
        why: what the test does, where its name does not say.
    """

    says: str
    test: str
    why: str = ""


def load_claims(root: Path) -> list[Claim]:
    """The claims in ``docs/claims.yaml``."""
    return [Claim(**entry) for entry in YAML(typ="safe").load(root / "docs" / "claims.yaml")]


def claims_page(root: Path) -> str:
    """The claims as a table."""
    rows = [(claim.says, _link(claim.test), claim.why) for claim in load_claims(root)]
    return INTRODUCTION + "\n" + markdown_table(("the README says", "tested by", "how"), rows) + "\n"


def _link(test: str) -> str:
    file, _, name = test.partition("::")
    return f"[`{name or file}`](../{file}{'#' + name.replace('::', '.') if name else ''})"


def one_space(text: str) -> str:
    """A text with all white space as one space."""
    return re.sub(r"\s+", " ", text)
