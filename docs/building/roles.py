"""References in docstrings (``:func:`drake_formation.simulate` ``), which are written for Sphinx, as Markdown.

An extension of griffe, which mkdocstrings loads.
"""

import re
from typing import Any

from griffe import Extension

ROLE = re.compile(r":(?:py:)?[a-z]+:`~?([\w.]+)`")


def in_markdown(text: str) -> str:
    """A docstring with its references as code, and without the second colon before a block of code."""
    return re.sub(r"::$", ":", ROLE.sub(r"`\1`", text), flags=re.MULTILINE)


class Roles(Extension):
    """Docstrings as Markdown."""

    def on_instance(self, *, obj: Any, **_: Any) -> None:
        """Look at a docstring."""
        if obj.docstring:
            obj.docstring.value = in_markdown(obj.docstring.value)
