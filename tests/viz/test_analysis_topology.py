"""The figure of error against channels shows what the front says."""

import numpy as np
import pytest

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.topology.cheapest_graph import ForceNoise, pareto_front
from drake_formation.analysis.topology.results import GraphPoint, ParetoFront
from drake_formation.viz.analysis_topology import MOST_DRAWN, error_against_channels
from drake_formation.viz.style import figure_of


@pytest.fixture(scope="module")
def front():
    scenario = load_scenario("quadrilateral", overrides={"consensus.delta": 2e4, "springs.law": "linear"})
    return pareto_front(linearize(scenario), measure=ForceNoise())


def searched(points):
    """A front of made-up graphs with bounds."""
    made = [
        GraphPoint(((1, 2), (2, 3)), 4 + 2 * k, 1.0 / (k + 1), (0.0, 1.0, 3.0), 0.9 / (k + 1)) for k in range(points)
    ]
    tried = np.array([(point.channels, point.error_m) for point in made])
    return ParetoFront(tuple(made), "an error", False, "a search", tried)


def labelled(axes):
    return dict(zip(axes.get_legend_handles_labels()[1], axes.get_legend_handles_labels()[0], strict=True))


def test_best_graphs_and_all_others_are_shown_in_millimetres(front):
    axes = error_against_channels(front)[0]
    best = labelled(axes)["best of all graphs"].get_xydata()
    np.testing.assert_allclose(best, [(point.channels, 1000 * point.error_m) for point in front.points])
    assert len(labelled(axes)["other graphs tried"].get_xydata()) == len(front.tried) == 6


def test_spectra_of_all_points_are_shown(front):
    axes = error_against_channels(front)[1]
    shown = {tuple(np.round(place, 6)) for dots in axes.collections for place in dots.get_offsets()}
    assert shown == {(point.channels, round(value, 6)) for point in front.points for value in point.spectrum[1:]}
    neighbours = labelled(axes)["fewest neighbours of a robot"].get_ydata()
    assert list(neighbours) == [1, 2, 2, 3]


def test_few_graphs_are_drawn_and_many_are_not(front):
    panels = error_against_channels(front)
    assert len(panels) == 3
    drawings = panels[2].child_axes
    assert [len(drawing.lines) for drawing in drawings] == [len(point.edges) + 1 for point in front.points]
    assert len(error_against_channels(searched(MOST_DRAWN + 1))) == 2


def test_bounds_are_shown_where_not_all_were_tried(front):
    assert "no graph is better" not in labelled(error_against_channels(front)[0])
    made = searched(5)
    bounds = labelled(error_against_channels(made)[0])["no graph is better"].get_ydata()
    np.testing.assert_allclose(bounds, [1000 * point.bound_m for point in made.points])


def test_a_figure_can_be_written(front, tmp_path):
    figure_of(error_against_channels(front)).savefig(tmp_path / "front.png")
    assert (tmp_path / "front.png").stat().st_size > 10_000
