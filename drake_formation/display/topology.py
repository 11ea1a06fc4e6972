"""Answers about communication graphs as HTML: the graphs drawn, and how well they serve."""

from drake_formation.analysis.topology.results import CheapestGraph, GraphPoint, ParetoFront
from drake_formation.display.graph import circle, drawing
from drake_formation.display.markup import QUIET, element, html, table
from drake_formation.display.plane import Plane


def cheapest_graph_html(found: CheapestGraph) -> str:
    """The graph, and what is known of it."""
    graph = found.graph
    rows = [
        ("channels", str(graph.channels), "" if found.optimal else f"at least {found.least_channels} are needed"),
        ("error", f"{graph.error_m:.4g} m", f"{found.measure}; asked for: below {found.error_bound_m:.4g} m"),
        ("proof", found.proof, ""),
    ]
    return html(element("div", _graph(graph).svg, table(rows)))


def pareto_front_html(found: ParetoFront) -> str:
    """The graphs that none with fewer channels equals or beats, and why."""
    graphs = element("div", style="display: flex; flex-wrap: wrap; gap: 12px")
    for point in found.front:
        label = element("div", f"{point.channels} channels: {point.error_m:.4g} m")
        graphs.append(element("div", _graph(point).svg, label))
    return html(element("div", graphs, element("div", f"{found.measure}. {found.proof}", style=QUIET)))


def graph_point_svg(point: GraphPoint) -> str:
    """A graph between robots on a circle."""
    return html(_graph(point).svg)


def _graph(point: GraphPoint) -> Plane:
    both_ways = [(i - 1, j - 1) for edge in point.edges for i, j in (edge, edge[::-1])]
    return drawing(circle(len(point.spectrum)), channels=both_ways)
