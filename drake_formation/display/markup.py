"""HTML and SVG as trees: what a user has written is text in them, whatever it looks like."""

from collections.abc import Iterable
from xml.etree.ElementTree import Element, tostring

CELL = "text-align: left; vertical-align: top; padding: 2px 12px 2px 0"
QUIET = "color: #888"


def element(tag: str, *content: "Element | str", **attributes: object) -> Element:
    """An element with what is in it, in order; ``_`` in the name of an attribute stands for ``-``."""
    made = Element(tag, {name.replace("_", "-"): str(value) for name, value in attributes.items()})
    for item in content:
        if isinstance(item, Element):
            made.append(item)
        elif len(made):
            made[-1].tail = (made[-1].tail or "") + item
        else:
            made.text = (made.text or "") + item
    return made


def table(rows: Iterable[Iterable[str]], head: Iterable[str] = ()) -> Element:
    """A table; what is in its first column is a name, and in others than the first two a remark."""
    made = element("table", style="border-collapse: collapse")
    if titles := list(head):
        made.append(element("tr", *(element("th", title, style=CELL) for title in titles)))
    for row in rows:
        cells = [element("td", text, style=_look(column)) for column, text in enumerate(row)]
        made.append(element("tr", *cells))
    return made


def _look(column: int) -> str:
    return f"{CELL}; font-family: monospace" if column == 0 else CELL if column == 1 else f"{CELL}; {QUIET}"


def html(*parts: Element) -> str:
    """Parts one below the other, as HTML."""
    return "".join(tostring(part, encoding="unicode", method="html") for part in parts)
