"""The report: Markdown, the same as one self-contained HTML page, and the tables as CSV."""

import base64
import csv
import html
from collections.abc import Iterable
from functools import partial
from importlib.metadata import version
from pathlib import Path

from drake_formation.paper.readings.two_readings import READINGS
from drake_formation.paper.section import Section
from drake_formation.paper.tables import Cell
from drake_formation.places import Kind
from drake_formation.viz.style import attempt_each

RUNS = "runs"
REPORT = Kind(RUNS, ("figures", "report.md", "tables.csv", "report.html"))
"""A folder with runs is a study's, finished or not."""

TITLE = "Hierarchical decentralized LQR formation control, reproduced"

INTRODUCTION = """Every number here comes from the block diagrams of drake_formation {ours} on Drake {drake}, compiled.
Errors are in centimetres where the paper prints %; ‖e_i‖ is the consensus error of one robot, and tables and figures
show that of the robot farthest off; ‖ε_i‖ is the tracking error of one robot, ‖ε‖ that of all robots together.
*Published* is printed in the paper, *inferred* follows from what it prints, *chosen* is ours where the paper is
silent."""

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
table { border-collapse: collapse; margin: 1rem 0; font-size: 14px; }
th, td { border-bottom: 1px solid #ddd; padding: 0.25rem 0.6rem; text-align: left; vertical-align: top; }
img { max-width: 100%; }
h2 { margin-top: 2.5rem; font-size: 1.2rem; }
"""


def write_report(folder: Path, sections: Iterable[Section], file_format: str = "png") -> dict[str, str]:
    """Write ``report.md`` with its ``figures/``, ``report.html`` and ``tables.csv``.

    Args:
        folder: a folder that exists.
        sections: in order.
        file_format: in which pictures are written too, if another.

    Returns:
        Pictures that could not be drawn, by name, and why; the report says so in their places.
    """
    figures = folder / "figures"
    figures.mkdir(exist_ok=True)
    parts, cells = [], []
    failed: dict[str, str] = {}
    for section in sections:
        for suffix in sorted({"png", file_format}):
            files = {name: figures / f"{name}.{suffix}" for name in section.pictures}
            failed |= attempt_each({name: partial(draw, files[name]) for name, draw in section.pictures.items()})
        images = [_image(section, name, failed.get(name)) for name in section.pictures]
        parts.append("\n\n".join(filter(None, [f"## {section.title}", section.text, *images])))
        cells.extend(section.cells)
    introduction = INTRODUCTION.format(ours=version("drake-formation"), drake=version("drake"))
    markdown = "\n\n".join([f"# {TITLE}", introduction, *parts]) + "\n"
    (folder / "report.md").write_text(markdown, encoding="utf-8")
    (folder / "report.html").write_text(to_html(markdown, folder), encoding="utf-8")
    write_csv(folder / "tables.csv", cells)
    return failed


def _image(section: Section, name: str, failure: str | None) -> str:
    return f"![{section.title}](figures/{name}.png)" if failure is None else f"*No figure {name}: {failure}*"


def to_html(markdown: str, folder: Path) -> str:
    """A page with the figures, which Markdown names relative to a folder, inside it."""
    from markdown_it import MarkdownIt

    parser = MarkdownIt("commonmark").enable("table")
    tokens = parser.parse(markdown)
    for token in tokens:
        for child in token.children or ():
            if child.type == "image":
                picture = (folder / str(child.attrs["src"])).read_bytes()
                child.attrs["src"] = f"data:image/png;base64,{base64.b64encode(picture).decode()}"
    body = parser.renderer.render(tokens, parser.options, {})
    head = f'<meta charset="utf-8"><title>{html.escape(TITLE)}</title><style>{STYLE}</style>'
    return f'<!doctype html>\n<html lang="en"><head>{head}</head>\n<body>\n{body}</body></html>\n'


def write_csv(path: Path, cells: Iterable[Cell]) -> None:
    """One row a cell."""
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        columns = [f"{key}{what}" for key in READINGS for what in ("", "_agrees", "_set", "_reason")]
        writer.writerow(["table", "row", "column", "unit", "published", *columns, "rerun"])
        for cell in cells:
            values = [
                value
                for key in READINGS
                for value in (
                    repr(cell.ours[key]),
                    cell.agrees(key),
                    cell.set_by.get(key, ""),
                    cell.reasons.get(key, ""),
                )
            ]
            writer.writerow([cell.table, cell.row, cell.column, cell.unit, repr(cell.published), *values, cell.rerun])
