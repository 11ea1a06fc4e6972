"""Every example of the site runs as it stands: files are those whose name is above them, the rest is run in order."""

import re
import shlex
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[2] / "docs"
BLOCK = re.compile(r"^```(\w+)([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PAGES = sorted(DOCS.rglob("*.md"))
SLOW = {"bandwidth", "cluster", "compare", "film", "ring", "tutorial"}


def blocks(page):
    return [(language, re.search(r'title="([^"]+)"', rest), text) for language, rest, text in
            BLOCK.findall(page.read_text(encoding="utf-8"))]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=page.stem, marks=[pytest.mark.slow] if page.stem in SLOW else [])
        for page in PAGES
        if any(language in {"yaml", "python", "sh"} for language, _, _ in blocks(page))
    ],
)
def test_page(page, cli, parts_of_a_session):
    names = {"__name__": "__main__"}
    for language, title, text in blocks(page):
        if language == "python":
            exec(compile(text, f"{page}", "exec"), names)
        elif language == "sh":
            for line in text.strip().splitlines():
                command, *arguments = shlex.split(line, comments=True)
                assert command == "drake-formation"
                status, _, err = cli(*arguments)
                assert status == 0, err
        elif language == "yaml":
            assert title, f"{page}: a file has its name above it"
            Path(title[1]).write_text(text, encoding="utf-8")
        else:
            assert language == "text", f"{page}: {language} is not run"


def test_twelve_questions_are_answered():
    listed = re.findall(r"\]\((\w+)\.md\)", (DOCS / "how_to/index.md").read_text(encoding="utf-8"))
    assert len(listed) == 12
    assert {f"{name}.md" for name in listed} == {page.name for page in (DOCS / "how_to").glob("*.md")} - {"index.md"}
