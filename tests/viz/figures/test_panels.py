"""Figures are as wide as a journal's columns, and what explains them covers nothing that is drawn."""

import pytest
from made_up_run import made_up_run

from drake_formation.viz.figures import FIGURES, WIDTHS
from drake_formation.viz.style import figure_of, own_style

RUNS = {
    "eight robots": made_up_run(),
    "three runs": {
        "rubber": made_up_run(2, stiff=False),
        "steel": made_up_run(2),
        "steel, δ = 1e4 N/m": made_up_run(3),
    },
}


@pytest.mark.parametrize(
    ("name", "run", "width"),
    [(name, "eight robots", width) for name in FIGURES if name != "tracking_error" for width in WIDTHS]
    + [(name, "three runs", "column") for name in ("paths", "overview", "tracking_error")],
)
def test_a_legend_is_in_the_figure_and_outside_all_axes(name, run, width):
    with own_style():
        drawn = FIGURES[name](RUNS[run], width=width)
        figure = figure_of(drawn)
        figure.draw_without_rendering()
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend()]
    assert len(legends) == 1
    (legend,) = (each.get_window_extent() for each in legends)
    assert not any(legend.overlaps(axes.bbox) for axes in figure.axes)
    assert figure.bbox.x0 - 1 <= legend.x0
    assert legend.x1 <= figure.bbox.x1 + 1
    assert legend.y1 <= figure.bbox.y1 + 1
    assert figure.get_figwidth() * 25.4 == pytest.approx(WIDTHS[width])


@pytest.mark.parametrize("name", FIGURES)
def test_every_axis_says_what_it_shows_with_its_symbol_and_unit(name):
    figure = figure_of(FIGURES[name](RUNS["eight robots"]))
    labels = [axes.get_ylabel() for axes in figure.axes] + [figure.axes[-1].get_xlabel()]
    assert all("$" in label and label.endswith(")") for label in labels)


def test_a_notebook_shows_the_figure_of_what_a_function_gives():
    for drawn in (FIGURES["tracking_error"](RUNS["three runs"]), FIGURES["overview"](RUNS["three runs"])):
        assert drawn._repr_png_().startswith(b"\x89PNG")


def test_another_width_is_refused():
    with pytest.raises(ValueError, match="column or a page, not 'poster'"):
        FIGURES["paths"](RUNS["eight robots"], width="poster")
