"""Notebooks as one page each: their text and code, without results."""

import json
from pathlib import Path

INTRODUCTION = """# Notebooks

Each is a file in `notebooks/`: `pip install 'drake-formation[notebook]'`, and open it in Jupyter. Here are their text
and code, without results.
"""


def notebooks_page(files: list[Path]) -> str:
    """A list of notebooks by their titles."""
    titles = [notebook_page(file).partition("\n")[0].lstrip("# ") for file in files]
    entries = [f"- [{title}](../notebooks/{file.name})" for title, file in zip(titles, files, strict=True)]
    return INTRODUCTION + "\n" + "\n".join(entries) + "\n"


def notebook_page(file: Path) -> str:
    """A notebook in Markdown."""
    notebook = json.loads(file.read_text(encoding="utf-8"))
    return "\n\n".join(_cell(cell["cell_type"], "".join(cell["source"])) for cell in notebook["cells"]) + "\n"


def _cell(kind: str, source: str) -> str:
    return source if kind == "markdown" else f"```python\n{source}\n```"
