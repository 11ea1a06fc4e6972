"""Figures of a run over time show what the run holds, from the hand-off on."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.vectors import length
from drake_formation.viz import figures
from drake_formation.viz.figures.envelope import envelope

QUICK = {"aggregation.duration": 3.0, "transport.duration": 8.0, "robots.start": {"centre": [2.5, 3.5]}}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=QUICK))


def line_of(axes, label):
    (line,) = (line for line in axes.lines if line.get_label() == label)
    return line


def test_a_line_is_the_series_of_its_robot_after_the_hand_off(result):
    axes = figures.tracking_error(result)
    carried = result.isel(time=result.phase.values == 1)
    for robot in (1, 2):
        error = 100 * length(carried.deviation).sel(robot=robot).values
        times, _, upper = envelope(carried.time.values, error)
        np.testing.assert_array_equal(line_of(axes, f"robot {robot}").get_xydata(), np.column_stack([times, upper]))
    assert axes.get_xlim() == (3.0, 11.0)


def test_the_whole_of_a_run_is_shown_where_asked_and_says_what_is_the_aggregation(result):
    axes = figures.consensus_error(result, whole=True)
    assert axes.get_xlim() == (0.0, 11.0)
    assert "aggregation" in axes.get_legend_handles_labels()[1]


def test_forces_are_drawn_in_four_axes_with_the_papers_symbols(result):
    panels = figures.control_forces(result)
    assert [panel.get_ylabel().split("\n")[0] for panel in panels] == [
        "control force", "local LQR force", "consensus force", "avoidance force",
    ]  # fmt: skip
    assert all("$" in panel.get_ylabel() and panel.get_ylabel().endswith("(N)") for panel in panels)


def test_what_does_not_act_is_said_to_be_zero(result):
    panel = figures.control_forces(result)[2]
    assert float(result.consensus_force.max()) == 0.0
    assert [text.get_text() for text in panel.texts] == ["zero throughout"]


def test_of_several_results_the_largest_is_a_line_each(result):
    axes = figures.spring_lengths({"rubber": result, "half": result.assign(spring_length=result.spring_length + 0.05)})
    carried = result.isel(time=result.phase.values == 1)
    for name, more in (("rubber", 0.0), ("half", 0.05)):
        largest = 100 * np.abs(carried.spring_length + more - carried.rest_length).max("spring").values
        np.testing.assert_allclose(line_of(axes, name).get_ydata(), envelope(carried.time.values, largest)[2])
    assert "|" in axes.get_ylabel()


def test_a_user_brings_axes(result):
    from matplotlib.figure import Figure

    mine = Figure().subplots(2, 2)
    assert figures.tracking_error(result, mine[0, 0]) is mine[0, 0]
    assert figures.control_forces(result, mine)[3] is mine[1, 1]
    with pytest.raises(ValueError, match="4 axes are drawn into, and 2 were given"):
        figures.control_forces(result, mine[0])
