"""Figures of runs, as the paper shows them.

Each function takes one result, or several that are laid over each other, and axes to draw into; it gives the axes. A
figure is ``axes.figure`` of these, and a notebook shows it where they end a cell. Without axes a function makes a
figure in this project's style, as wide as a journal's column (88 mm) or page (180 mm). Axes of your own are in that
style where they were made under :func:`drake_formation.viz.style.own_style`, or after
``plt.style.use("drake_formation.viz.paper")``.

- ``paths``: in the plane, with obstacles and the formation along the way.
- ``tracking_error``, ``consensus_error``, ``spring_lengths``, ``control_forces``: over time.
- ``overview``: paths, errors, and how old what robots knew of each other was.
- ``write_figures``: all of them, each in a file.
- ``robot_looks``, ``robot_colours``: by which robots are told apart in every picture.
"""

from drake_formation.viz.figures.files import FIGURES, write_figures
from drake_formation.viz.figures.histories import consensus_error, control_forces, spring_lengths, tracking_error
from drake_formation.viz.figures.looks import robot_colours, robot_looks
from drake_formation.viz.figures.overview import overview
from drake_formation.viz.figures.panels import WIDTHS
from drake_formation.viz.figures.plane import draw_formation, paths, snapshot_times

__all__ = [
    "FIGURES",
    "WIDTHS",
    "consensus_error",
    "control_forces",
    "draw_formation",
    "overview",
    "paths",
    "robot_colours",
    "robot_looks",
    "snapshot_times",
    "spring_lengths",
    "tracking_error",
    "write_figures",
]
