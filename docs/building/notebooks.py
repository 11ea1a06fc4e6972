"""Notebooks as one page each: their text and code, without results."""

import json
from pathlib import Path


def notebook_page(file: Path) -> str:
    """A notebook in Markdown."""
    notebook = json.loads(file.read_text(encoding="utf-8"))
    return "\n\n".join(_cell(cell["cell_type"], "".join(cell["source"])) for cell in notebook["cells"]) + "\n"


def _cell(kind: str, source: str) -> str:
    return source if kind == "markdown" else f"```python\n{source}\n```"
