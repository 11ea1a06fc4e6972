"""Where a link to a file of the project leads in the site.

Pages link to files as they lie in the project, so that links also work where the project is browsed as files. In the
site a page leads to its page, a picture to a copy, and any other file to a page that shows it.
"""

import re
from os.path import relpath
from pathlib import Path, PurePosixPath

from building.sources import anchor_of

FENCED = re.compile(r"(^ *(`{3,}|~{3,}).*?^ *\2 *$)", re.DOTALL | re.MULTILINE)
LINK = re.compile(r"(!?\[(?:[^\]\[]|\[[^\]]*\])*\]\()([^)\s#]*)(#[^)\s]*)?(\))")
PICTURES = {".png", ".svg", ".gif"}


class BrokenLinkError(ValueError):
    """Links that lead nowhere."""


class Links:
    """The links of all pages, and which files they ask the site to show.

    Attributes:
        shown: files that a link leads to and that are no page of their own, by the page that shows them.
        pictures: pictures by where they are in the site.
        broken: what leads nowhere, a sentence each.
    """

    def __init__(self, root: Path, pages: dict[Path, PurePosixPath]) -> None:
        """Take the project's folder, and the pages of the site by the files they come from."""
        self.root, self.pages = root, pages
        self.shown: dict[Path, PurePosixPath] = {}
        self.pictures: dict[Path, PurePosixPath] = {}
        self.broken: list[str] = []

    def of_site(self, text: str, file: Path, page: PurePosixPath) -> str:
        """A Markdown text with its links as the site needs them.

        Args:
            text: Markdown; fenced code in it is left alone.
            file: where it is written, to which its links are relative.
            page: which page it becomes.
        """

        def led(match: re.Match[str]) -> str:
            before, target, fragment, after = match.groups()
            if not target or "://" in target or target.startswith("mailto:"):
                return match[0]
            return before + self._target(target, fragment or "", file, page) + after

        pieces = FENCED.split(text)
        return "".join(piece if n % 3 == 1 else LINK.sub(led, piece) for n, piece in enumerate(pieces) if n % 3 != 2)

    def _target(self, target: str, fragment: str, file: Path, page: PurePosixPath) -> str:
        aim = (file.parent / target).resolve()
        place = self._place(aim)
        if place is None:
            self.broken.append(f"{file.relative_to(self.root)}: there is no {target}")
            return target
        if aim in self.shown and fragment:
            anchor = anchor_of(aim, fragment[1:])
            if anchor is None:
                self.broken.append(f"{file.relative_to(self.root)}: {target} has no {fragment[1:]}")
            fragment = f"#{anchor}"
        return relpath(place, page.parent) + fragment

    def _place(self, aim: Path) -> PurePosixPath | None:
        """Where a file is in the site, which is told to have it there."""
        if aim in self.pages:
            return self.pages[aim]
        if not aim.exists() or not aim.is_relative_to(self.root):
            return None
        name = aim.relative_to(self.root).as_posix()
        if aim.suffix in PICTURES:
            return self.pictures.setdefault(aim, PurePosixPath("assets", name))
        return self.shown.setdefault(aim, PurePosixPath("source", f"{name}.md"))

    def require_all(self) -> None:
        """Raise BrokenLinkError if a link leads nowhere."""
        if self.broken:
            raise BrokenLinkError("\n".join(self.broken))
