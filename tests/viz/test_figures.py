"""Figures of a run show what the run holds."""

import warnings

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.viz import figures, run_figures

QUICK = {"aggregation.duration": 3.0, "transport.duration": 8.0, "robots.start": {"centre": [2.5, 3.5]}}
AT_REST = {"aggregation.duration": 0.0, "transport.goal": [2.5, 3.5]}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=QUICK))


def test_every_figure_is_written(result, tmp_path):
    assert run_figures.write_figures(result, tmp_path) == {}
    assert {path.stem for path in tmp_path.iterdir()} == set(run_figures.FIGURES)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in tmp_path.iterdir())


@pytest.mark.parametrize("name", run_figures.FIGURES)
def test_every_axis_has_a_label_with_its_unit(result, name):
    axes = run_figures.FIGURES[name](result).axes
    assert axes[-1].get_xlabel()
    assert all("(" in ax.get_ylabel() for ax in axes)


def test_paths_follow_the_positions(result):
    (axes,) = figures.paths(result).axes
    carried = result.position.values[result.phase.values == 1]
    lines = {line.get_label(): line for line in axes.lines}
    for robot in (1, 2):
        np.testing.assert_array_equal(lines[f"robot {robot}"].get_xydata(), carried[:, robot - 1])


def test_paths_have_one_scale_and_show_every_obstacle(result):
    (axes,) = figures.paths(result).axes
    assert axes.get_aspect() == 1.0
    ranges = [patch for patch in axes.patches if not patch.fill]
    assert [patch.center for patch in ranges] == [(6.0, 5.05), (20.0, 1.9)]
    assert {patch.radius for patch in ranges} == {1.3}


def test_snapshots_run_from_hand_off_to_end(result):
    times = figures.snapshot_times(result)
    assert times[0] == result.attrs["hand_off_time_s"]
    assert times[-1] == result.time.values[-1]
    assert np.all(np.diff(times) > 0)


def test_every_robot_has_a_colour_of_its_own():
    start = {"formation": {"shape": "line", "robots": 12, "side": 1.0}, "robots.start": {"centre": [2.5, 3.5]}}
    many = simulate(
        load_scenario("line", overrides={**QUICK, **start, "springs.graph": "path", "transport.duration": 1})
    )
    assert len(set(figures.robot_colours(many).values())) == 12


@pytest.mark.parametrize(
    "overrides",
    [
        {"avoidance.obstacles": []},
        {"springs.graph": []},
        {"aggregation.duration": 0.0},
        {"formation": {"shape": "line", "robots": 1, "side": 1.0}},
        {"formation": {"shape": "line", "robots": 1, "side": 1.0}, **AT_REST, "avoidance.obstacles": []},
        AT_REST,
        {**AT_REST, "consensus.graph": [], "springs.graph": []},
        {**AT_REST, "transport.goal": [1e6, 1e6], "robots.start": {"centre": [1e6, 1e6]}},
        {"transport.duration": 1e-9},
        {"transport.duration": 1e-6, "aggregation.duration": 1e-9},
        {"robots.mass": 1e12},
        {"robots.mass": 1e-6, "tracking.R": 1e9},
        {"springs.stiffness": 0.0, "consensus.delta": 1e6},
        {"formation": {"shape": "line", "robots": 12, "side": 1e-3}},
    ],
)
def test_figures_of_what_is_missing_are_drawn_too(overrides, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert (
            run_figures.write_figures(simulate(load_scenario("line", overrides={**QUICK, **overrides})), tmp_path) == {}
        )
