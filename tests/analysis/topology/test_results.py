"""Answers about graphs: what is on the front, and plain values."""

import numpy as np

from drake_formation.analysis.topology.results import CheapestGraph, GraphPoint, ParetoFront


def point(channels, error):
    return GraphPoint(((1, 2),), channels, error, (0.0, 2.0), error / 2)


def test_front_leaves_out_what_costs_more_for_nothing():
    points = (point(6, 3.0), point(8, 2.0), point(10, 2.0), point(12, 2.5), point(14, 1.0))
    front = ParetoFront(points, "an error", True, "all tried", np.zeros((0, 2))).front
    assert [each.channels for each in front] == [6, 8, 14]


def test_plain_values_have_units():
    best = CheapestGraph(point(6, 3.0), 4.0, "an error", 6, True, "all tried")
    values = best.to_dict()
    assert values["edges"] == [[1, 2]]
    assert (values["error_m"], values["least_error_m"], values["error_bound_m"]) == (3.0, 1.5, 4.0)
    assert (
        ParetoFront((point(6, 3.0),), "an error", True, "x", np.zeros((0, 2))).to_dict()["points"][0]["channels"] == 6
    )
