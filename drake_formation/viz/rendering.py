"""Graphviz's language drawn to files, with nothing but what pip installs.

Graphviz comes with pip as ``graphviz-pure``, whose pictures are the same on every machine. It writes no PDF:
``fpdf2`` converts the SVG.
"""

import html
import re
import subprocess
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import cast

PIXELS_PER_INCH = 192  # twice a screen's


def render(dot: str, path: Path) -> None:
    """Draw Graphviz's language to a file.

    Args:
        dot: the text to draw.
        path: where to; the suffix is the format: .dot (the text itself), .svg, .png or .pdf.

    Raises:
        ValueError: the suffix is another one, or the text is not Graphviz's language.
        FileNotFoundError: there is no such folder.
    """
    require_format(path)
    if not path.parent.is_dir():
        raise FileNotFoundError(f"cannot draw {path.name}: there is no folder {path.parent}")
    path.write_bytes(_FORMATS[path.suffix](dot))


def require_format(path: Path) -> None:
    """See to it that a file's suffix is a format that can be drawn.

    Raises:
        ValueError: it is not.
    """
    if path.suffix not in _FORMATS:
        raise ValueError(f"cannot draw {path.name}: the name must end in {', '.join(_FORMATS)}")


def svg(dot: str) -> str:
    """Graphviz's language as SVG.

    Raises:
        ValueError: the text is not Graphviz's language.
    """
    return _graphviz(dot, "-Tsvg").decode()


def laid_out(dot: str) -> str:
    """Graphviz's language with where everything is.

    Raises:
        ValueError: the text is not Graphviz's language.
    """
    return _graphviz(dot, "-Tdot").decode()


def _graphviz(dot: str, *options: str) -> bytes:
    """What Graphviz makes of the text."""
    run = subprocess.run([_program(), *options], input=dot.encode(), capture_output=True, check=False)
    if run.returncode:
        raise ValueError(f"Graphviz cannot read the text: {run.stderr.decode().strip()}")
    return run.stdout


def _program() -> str:
    """The Graphviz that pip installed beside this package, whatever else PATH holds."""
    files = metadata.distribution("graphviz-pure").files or []
    return str(next(file.locate() for file in files if file.stem == "graphviz-pure"))


def _pdf(dot: str) -> bytes:
    from fpdf import FPDF  # slow to import, and seldom needed
    from fpdf.svg import SVGObject

    # fpdf2 knows neither titles nor links (they show under the mouse), and drops what is inside the latter.
    plain = re.sub(r"<title>.*?</title>|</?a\b[^>]*>", "", svg(dot))
    if foreign := set(html.unescape(plain)) - set(map(chr, range(256))):
        raise ValueError(f"a PDF's own fonts lack {', '.join(sorted(foreign))}: draw an .svg or a .png")
    drawing = SVGObject(plain)
    pdf = FPDF(unit="pt", format=cast(tuple[float, float], (drawing.width, drawing.height)))
    pdf.add_page()
    drawing.draw_to_page(pdf)
    return bytes(pdf.output())


_FORMATS: dict[str, Callable[[str], bytes]] = {
    ".dot": str.encode,
    ".svg": lambda dot: svg(dot).encode(),
    ".png": lambda dot: _graphviz(dot, "-Tpng", f"-Gdpi={PIXELS_PER_INCH}"),
    ".pdf": _pdf,
}
