"""LaTeX as pictures within the page, so that formulas need no script and no font."""

import html
import re

ARITHMATEX = re.compile(r'<(span|div) class="arithmatex">\\[(\[](.*?)\\[)\]]</\1>', re.DOTALL)
SIZE = 100.0
"""Of the font, in the units of the picture."""

COMMANDS = {1: "M", 2: "L", 3: "Q", 4: "C", 79: "Z"}
"""SVG's letters for Matplotlib's codes of a path."""


def draw_formulas(page: str) -> str:
    """An HTML page with the formulas that Arithmatex has marked drawn."""
    return ARITHMATEX.sub(lambda match: _picture(html.unescape(match[2]).strip(), match[1] == "div"), page)


def _picture(latex: str, displayed: bool) -> str:
    """A formula in the colour of the text, standing on its line.

    Raises:
        ValueError: Matplotlib does not know the LaTeX.
    """
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    line = " ".join(latex.split())  # Matplotlib takes one line alone
    large = line.replace(r"\frac", r"\dfrac") if displayed else line
    path = TextPath((0, 0), f"${large}$", size=SIZE, prop=FontProperties(math_fontfamily="cm"))
    left, bottom, right, top = (round(value) for value in path.get_extents().padded(4).extents)
    outline = "".join(
        COMMANDS[int(code)] + " ".join(f"{value:.1f}" for value in points)
        for points, code in path.iter_segments(simplify=False)
        if code
    )
    outline = re.sub(r"Z[-0-9. ]*", "Z", outline)
    label = html.escape(latex, quote=True)
    picture = (
        f'<svg class="formula" role="img" aria-label="{label}" viewBox="{left} {-top} {right - left} {top - bottom}" '
        f'style="width:{(right - left) / SIZE:.3f}em;height:{(top - bottom) / SIZE:.3f}em;'
        f'vertical-align:{bottom / SIZE:.3f}em"><path transform="scale(1 -1)" d="{outline}"/></svg>'
    )
    return f'<div class="formula">{picture}</div>' if displayed else picture
