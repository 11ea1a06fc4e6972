"""A result as HTML: the paths of its robots, and its metrics."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element

import numpy as np
from numpy.typing import NDArray

from drake_formation.display.markup import QUIET, element, html, table
from drake_formation.display.plane import Plane
from drake_formation.display.scenario import draw_obstacles, surroundings
from drake_formation.measuring import measured_so_far
from drake_formation.measuring.registry import known
from drake_formation.scenario.resolve import resolve
from drake_formation.simulation.result import series_of
from drake_formation.simulation.series import Series

if TYPE_CHECKING:
    import xarray as xr

    from drake_formation.measuring.metric import Value
    from drake_formation.viz.figures.looks import Colour

Array = NDArray[np.float64]

WIDTH, HEIGHT = 900.0, 420.0
"""Of the paths at the most (px)."""

FINEST = 0.3
"""What is smaller is not drawn (px)."""


def result_html(result: "xr.Dataset") -> str:
    """A result for a notebook.

    Raises:
        ValueError, ScenarioError: it is not a result of this version.
    """
    from drake_formation.viz.figures import robot_colours  # with Matplotlib, which is slow to import

    series = series_of(result)
    measured = measured_so_far(series)
    about = f" for {series['time'][-1] - series['time'][0]:.6g} s, engine {series.choice.engine}"
    heading = element("div", element("b", str(result.attrs["title"])), about)
    remark = element("div", str(result.attrs.get("remark", "")), style=QUIET)
    drawn = paths(series, list(robot_colours(result).values()))
    return html(element("div", heading, drawn.svg, _figures(measured), remark))


def metrics_html(metrics: "Mapping[str, Value]") -> str:
    """Metrics for a notebook: those that could be measured."""
    return html(_figures(metrics))


def _figures(metrics: "Mapping[str, Value]") -> Element:
    rows = [
        (metric.title, shown(metrics[name]), metric.unit if metric.unit != "1" else "")
        for name, metric in known().items()
        if metrics.get(name) is not None
    ]
    return table(rows)


def shown(value: "Value") -> str:
    """A metric's value in four digits."""
    numbers = value if isinstance(value, list) else [value]
    return ", ".join("none" if number is None else f"{number:.4g}" for number in numbers)


def paths(series: Series, colours: "Sequence[Colour]") -> Plane:
    """Where robots went, before the hand-off dotted, with their slots at the goal and the obstacles.

    Args:
        series: a run.
        colours: of its robots.
    """
    formation = resolve(series.scenario)
    positions, goal = series["position"], formation.goal + formation.slots
    plane = Plane(*surroundings(formation, [positions, goal]), WIDTH, HEIGHT)
    draw_obstacles(plane, formation)
    carried = series["phase"] == 1
    for i, (r, g, b, *_) in enumerate(colours):
        colour = f"rgb({255 * r:.0f}, {255 * g:.0f}, {255 * b:.0f})"
        for part, dashes in ((~carried, "2 3"), (carried, "none")):
            if part.sum() > 1:
                plane.line(_thinned(positions[part, i], FINEST / plane.scale), stroke=colour, stroke_dasharray=dashes)
        plane.dot(positions[-1, i], 3.5, fill=colour)
        plane.cross(goal[i], 3.0, stroke=colour)
    return plane


def _thinned(points: Array, tolerance: float) -> Array:
    """A line that is nowhere further than this from the one through all points (m)."""
    from shapely import LineString  # slow to import

    return np.array(LineString(points).simplify(tolerance).coords)
