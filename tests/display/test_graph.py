"""Graphs and what is answered about them, drawn."""

from xml.etree.ElementTree import fromstring

import networkx as nx
from shown import Shown

from drake_formation.analysis.topology.results import CheapestGraph, GraphPoint, ParetoFront
from drake_formation.formation.links import Channels, Edges

SQUARE = GraphPoint(((1, 2), (2, 3), (3, 4), (1, 4)), 8, 0.02, (0.0, 2.0, 2.0, 4.0), 0.02)


def test_edges_and_channels_are_svg_with_a_line_each():
    edges = Shown(Edges.of(nx.path_graph(3))._repr_svg_())
    assert (edges.count("polyline"), edges.count("text")) == (2, 3)
    channels = Channels.of(3, [(0, 1, 1.0), (1, 0, 1.0), (2, 1, 0.5)])
    drawn = channels._repr_svg_()
    assert fromstring(drawn).tag == "{http://www.w3.org/2000/svg}svg"
    shown = Shown(drawn)
    assert shown.count("polyline") == 2  # both ways, and one way
    assert shown.count("circle", fill="#009e73") == 1  # at the robot that hears


def test_one_robot_alone_can_be_drawn():
    assert Shown(Channels.of(1, [])._repr_svg_()).count("text") == 1


def test_answers_show_their_graph_and_say_why():
    found = CheapestGraph(SQUARE, 0.03, "hand-off <b>", 6, False, "by exhaustion")
    shown = Shown(found._repr_html_())
    assert shown.count("polyline") == 4
    assert shown.count("b") == 0
    assert "at least 6 are needed" in shown.text
    front = Shown(ParetoFront((SQUARE,), "hand-off", True, "all tried", None)._repr_html_())
    assert "8 channels: 0.02 m" in front.text
    assert Shown(SQUARE._repr_svg_()).count("circle") == 4
