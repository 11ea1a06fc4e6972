"""Drake's diagrams in a notebook. They are C++ objects that cannot show themselves, so IPython is told how to."""

import sys
from typing import Any

from pydrake.systems.framework import Diagram

MOST = 4
"""A formation of more robots is shown at a glance, with one of them opened: its wires are too many to follow."""


def show_diagrams() -> None:
    """Tell IPython, if it runs, how diagrams are drawn; whoever has told it before is obeyed."""
    ipython = sys.modules.get("IPython")
    shell: Any = ipython.get_ipython() if ipython else None
    if shell is None:
        return
    formatter = shell.display_formatter.formatters["image/svg+xml"]
    try:
        formatter.lookup_by_type(Diagram)
    except KeyError:
        formatter.for_type(Diagram, notebook_svg)


def notebook_svg(diagram: Diagram) -> str:
    """A diagram as a picture no wider than a notebook."""
    from drake_formation.viz.graphviz import diagram_svg
    from drake_formation.viz.graphviz_formation import formation_dot
    from drake_formation.viz.rendering import svg

    formation = getattr(diagram, "formation", None)
    drawn = diagram_svg(diagram) if formation is None or formation.robots <= MOST else svg(formation_dot(formation))
    _, _, picture = drawn.partition("<svg ")  # without the head of a file of its own
    return f'<svg style="max-width: 100%; height: auto; background: white" {picture}'
