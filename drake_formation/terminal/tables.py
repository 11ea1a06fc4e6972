"""Tables and headings: with boxes on a terminal, bare columns where something else reads them."""

import os
from typing import Any

from rich import box
from rich.console import Console, RenderableType
from rich.rule import Rule
from rich.table import Table
from rich.text import Text

from drake_formation.terminal.manner import MANNER

WIDE = 10_000
"""Columns where nobody looks: what is piped is not broken into lines."""


class OwnConsole(Console):
    """Standard output, or the error's: it takes texts as they are, brackets and colons too."""

    def __init__(self, stderr: bool = False, quiet: bool = False) -> None:
        asked_not_to = {"color_system": None} if os.environ.get("NO_COLOR") else {}
        super().__init__(markup=False, emoji=False, stderr=stderr, quiet=quiet, **asked_not_to)  # type: ignore[arg-type]
        if self.plain:
            self.width = WIDE

    @property
    def plain(self) -> bool:
        """Whether it shows neither lines nor colours: no terminal, or one that is dumb."""
        return not self.is_terminal or self.is_dumb_terminal

    def on_broken_pipe(self) -> None:
        """Let :func:`drake_formation.terminal.say` know; by itself rich would leave with status 1."""
        raise BrokenPipeError

    def render_str(self, text: str, **options: Any) -> Text:
        """Spelt out before a table is laid out, so that its columns stand straight."""
        return super().render_str(text.encode(self.encoding, "transliterate").decode(self.encoding), **options)

    def print(self, *objects: Any, **options: Any) -> None:
        """Print; what fills a line up to its end is left out where it is plain."""
        if not self.plain:
            super().print(*objects, **options)
            return
        with self.capture() as captured:
            super().print(*objects, **options)
        lines = [line.rstrip() for line in captured.get().split("\n")]
        self.file.write("\n".join(lines))


def console() -> OwnConsole:
    """Standard output, as it is now."""
    return OwnConsole()


def progress_console() -> OwnConsole:
    """Standard error for bars that move: silent where nobody looks, or nobody wants to."""
    err = OwnConsole(stderr=True)
    return OwnConsole(stderr=True, quiet=err.plain or not MANNER.shows_progress)


def table(*columns: str, title: str = "") -> Table:
    """An empty table for standard output.

    Args:
        columns: their headings.
        title: above it, if not empty.
    """
    plain = console().plain
    return Table(
        *columns, title=title or None, title_justify="left" if plain else "center",
        box=None if plain else box.HEAVY_HEAD, pad_edge=not plain,
    )  # fmt: skip


def heading(title: str) -> RenderableType:
    """A heading on a line of its own, as wide as a terminal."""
    return Text(title) if console().plain else Rule(title, align="left", style="dim")
