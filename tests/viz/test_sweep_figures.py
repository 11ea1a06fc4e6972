"""A sweep's figures show the numbers of its dataset at their values."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.colors import LogNorm
from matplotlib.contour import QuadContourSet
from sweep.quick import quick_sweep

from drake_formation.sweep import load_sweep
from drake_formation.sweep.coordinates import coordinates, dimensions
from drake_formation.viz.style import figure_of
from drake_formation.viz.sweep_figures import metric_figure, sweep_metrics, write_sweep_figures

STIFFNESS = {"path": "springs.stiffness", "logspace": [1.0, 1e4, 5]}
DELTA = {"path": "consensus.delta", "values": [0.0, 1e2, 1e3, 1e4]}
GRAPHS = {"path": "springs.graph", "values": ["complete", "cycle", "path"]}
SAMPLES = {"kind": "random", "seed": 1, "count": 50, "draw": {"robots.mass": {"uniform": [30.0, 50.0]}}}
CASES = {"kind": "zip", "values": {"springs.stiffness": [1.0, 5.0, 2.0], "springs.damping": [0.0, 1.0, 2.0]}}
FORCE = {"units": "N", "long_name": "peak control force"}


def dataset(*axes, values=None):
    """What a sweep over axes would give, with invented values."""
    sweep = load_sweep(quick_sweep(*axes, scenario="quadrilateral"))
    dims = dimensions(sweep.axes)
    if values is None:
        values = 1.0 + np.arange(float(len(sweep))).reshape(sweep.shape)
    robots = np.stack([values, 2 * values], axis=-1)
    return xr.Dataset(
        {
            "status": (dims, np.ones(sweep.shape, dtype=np.int8)),
            "error": (dims, np.full(sweep.shape, "", dtype=object)),
            "peak_force_n": (dims, values, FORCE),
            "tracking_error_m": ((*dims, "robot"), robots, {"units": "m", "long_name": "largest tracking error"}),
        },
        {each.name: (each.dimension, each.values, each.attributes) for each in coordinates(sweep.axes)},
        {"title": "invented"},
    )


def axes_of(results, name="peak_force_n"):
    panels = metric_figure(results, name)
    figure_of(panels).canvas.draw()
    return panels[0]


def test_one_axis_of_numbers_is_a_line_through_its_values():
    results = dataset(STIFFNESS)
    axes = axes_of(results)
    np.testing.assert_allclose(axes.lines[0].get_xdata(), results["stiffness"])
    np.testing.assert_allclose(axes.lines[0].get_ydata(), results["peak_force_n"])
    assert axes.get_xscale() == "log"
    assert axes.get_xlabel() == "stiffness $k_{ij}$ (N/m)"
    assert axes.get_ylabel() == r"peak control force $\|u_i\|$ (N)"


def test_a_metric_of_every_robot_is_drawn_by_its_largest():
    results = dataset(STIFFNESS)
    np.testing.assert_allclose(axes_of(results, "tracking_error_m").lines[0].get_ydata(), 2 * results["peak_force_n"])


def test_decades_from_zero_are_logarithmic_beyond_the_first():
    axes = axes_of(dataset(DELTA))
    assert axes.get_xscale() == "symlog"
    assert axes.xaxis.get_transform().linthresh == 100


def test_a_bit_rate_has_its_unit():
    rate = {"path": "consensus.medium.bit_rate", "logspace": [1e4, 1e6, 3]}
    medium = {
        "consensus.channel": {"kind": "packets", "period": 0.1, "delay": 0.0},
        "consensus.medium": {"kind": "tdma"},
    }
    coordinate, *_ = coordinates(load_sweep(quick_sweep(rate, scenario="quadrilateral", set=medium)).axes)
    assert coordinate.attributes["units"] == "bit/s"


def test_values_over_decades_are_on_a_logarithmic_scale():
    assert axes_of(dataset(DELTA, values=np.array([1.0, 3.0, 50.0, 2000.0]))).get_yscale() == "log"
    assert axes_of(dataset(DELTA, values=np.array([1.0, 3.0, 5.0, 20.0]))).get_yscale() == "linear"


def test_names_are_points_with_their_labels():
    axes = axes_of(dataset(GRAPHS))
    assert [text.get_text() for text in axes.get_xticklabels()] == ["complete", "cycle", "path"]
    assert axes.lines[0].get_linestyle() == "None"


def test_two_axes_of_numbers_are_a_heat_map_with_cells_about_their_values():
    results = dataset(STIFFNESS, DELTA)
    results["peak_force_n"][1, 2] = np.nan
    axes = axes_of(results)
    mesh = axes.collections[0]
    np.testing.assert_allclose(mesh.get_array().filled(np.nan), results["peak_force_n"])
    edges = np.array(mesh._coordinates)
    x, y = edges[0, :, 0], edges[:, 0, 1]
    assert (x[:-1] < results["delta"].values).all()
    assert (x[1:] > results["delta"].values).all()
    np.testing.assert_allclose(y, np.geomspace(10**-0.5, 10**4.5, 6))
    assert not isinstance(mesh.norm, LogNorm)


def test_heat_maps_over_decades_have_a_logarithmic_scale():
    values = np.geomspace(1, 1e5, 20).reshape(5, 4)
    assert isinstance(axes_of(dataset(STIFFNESS, DELTA, values=values)).collections[0].norm, LogNorm)


@pytest.mark.parametrize("order", [1, -1])
def test_names_beside_numbers_are_a_line_each(order):
    results = dataset(*[GRAPHS, STIFFNESS][::order])
    axes = axes_of(results)
    assert [line.get_label() for line in axes.lines] == ["complete", "cycle", "path"]
    for graph, line in zip(["complete", "cycle", "path"], axes.lines, strict=True):
        np.testing.assert_allclose(line.get_ydata(), results["peak_force_n"].sel(graph=graph))


def test_cases_are_drawn_over_the_first_field_that_moves():
    axes = axes_of(dataset(CASES))
    assert axes.get_xlabel() == "stiffness $k_{ij}$ (N/m)"
    np.testing.assert_allclose(axes.lines[0].get_xdata(), [1.0, 2.0, 5.0])
    np.testing.assert_allclose(axes.lines[0].get_ydata(), [1.0, 3.0, 2.0])


def test_samples_are_a_histogram_and_points_over_what_was_drawn():
    results = dataset(SAMPLES)
    histogram, points = metric_figure(results, "peak_force_n")
    assert sum(bar.get_height() for bar in histogram.patches) == 50
    np.testing.assert_allclose(np.sort(points.lines[0].get_xdata()), np.sort(results["mass"]))
    assert points.get_xlabel() == "mass $m_{i}$ (kg)"


def test_samples_along_an_axis_are_their_median_and_nine_tenths():
    results = dataset(STIFFNESS, SAMPLES)
    axes = axes_of(results)
    np.testing.assert_allclose(axes.lines[0].get_ydata(), results["peak_force_n"].median("sample"))
    band = axes.collections[0].get_paths()[0].vertices
    low = results["peak_force_n"].quantile(0.05, "sample")
    assert band[:, 1].min() == pytest.approx(float(low.min()))


def test_every_metric_has_a_file_and_old_ones_go(tmp_path):
    write_sweep_figures(dataset(STIFFNESS, DELTA), tmp_path / "figures")
    names = sorted(path.name for path in (tmp_path / "figures").iterdir())
    assert names == ["peak_force_n.png", "tracking_error_m.png"]
    results = dataset(STIFFNESS, DELTA)
    results["peak_force_n"][:] = np.nan
    write_sweep_figures(results, tmp_path / "figures", file_format="svg")
    assert [path.name for path in (tmp_path / "figures").iterdir()] == ["tracking_error_m.svg"]


def test_three_axes_and_unknown_metrics_are_not_drawn():
    assert sweep_metrics(dataset(STIFFNESS, DELTA)) == ["peak_force_n", "tracking_error_m"]
    assert sweep_metrics(dataset(STIFFNESS, DELTA, GRAPHS)) == []


@pytest.mark.parametrize("axes", [(STIFFNESS,), (GRAPHS,), (SAMPLES,), (STIFFNESS, DELTA), (GRAPHS, SAMPLES)])
def test_one_value_and_failed_runs_can_be_drawn(axes):
    results = dataset(*axes)
    results["peak_force_n"][:] = np.nan
    results["peak_force_n"][(0,) * len(axes)] = 7.0
    results["status"][-1] = 2
    figure = figure_of(metric_figure(results, "peak_force_n"))
    figure.canvas.draw()
    assert "runs failed" in figure.get_suptitle()


@settings(max_examples=30)
@given(
    axes=st.sampled_from(
        [(STIFFNESS,), (GRAPHS,), (SAMPLES,), (STIFFNESS, DELTA), (GRAPHS, SAMPLES), (DELTA, SAMPLES)]
    ),
    values=st.lists(
        st.floats(-1e100, 1e100) | st.sampled_from([0.0, 1.0, 1.0 + 1e-15, np.nan, np.inf]), min_size=1, max_size=8
    ),
)
def test_whatever_came_out_can_be_drawn(axes, values):
    results = dataset(*axes)
    shape = results["peak_force_n"].shape
    results["peak_force_n"][:] = np.resize(values, shape)
    for name in sweep_metrics(results):
        figure_of(metric_figure(results, name)).canvas.draw()


def test_the_boundaries_of_the_certificate_are_between_the_points_that_differ():
    labels = np.full((5, 4), "stable", dtype=object)
    labels[:, 2], labels[:, 3] = "not certified", "unstable"
    axes = metric_figure(dataset(STIFFNESS, DELTA), "peak_force_n", labels.astype(str))[0]
    lines = [collection for collection in axes.collections if isinstance(collection, QuadContourSet)]
    places = [line.get_paths()[0].vertices[:, 0] for line in lines]
    np.testing.assert_allclose(places[0], (1e2 + 1e3) / 2)
    np.testing.assert_allclose(places[1], (1e3 + 1e4) / 2)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [
        "certified stable up to here",
        "certified unstable from here",
    ]
