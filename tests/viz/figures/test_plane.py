"""Paths in the plane are where the robots were."""

import numpy as np
import pytest

from drake_formation import load_scenario, simulate
from drake_formation.viz import figures

QUICK = {"aggregation.duration": 3.0, "transport.duration": 8.0, "robots.start": {"centre": [2.5, 3.5]}}


@pytest.fixture(scope="module")
def result():
    return simulate(load_scenario("line", overrides=QUICK))


def test_paths_follow_the_positions(result):
    axes = figures.paths(result)
    carried = result.position.values[result.phase.values == 1]
    lines = {line.get_label(): line for line in axes.lines}
    for robot in (1, 2):
        np.testing.assert_array_equal(lines[f"robot {robot}"].get_xydata(), carried[:, robot - 1])


def test_paths_have_one_scale_and_show_every_obstacle(result):
    axes = figures.paths(result)
    assert axes.get_aspect() == 1.0
    ranges = [patch for patch in axes.patches if not patch.fill]
    assert [patch.center for patch in ranges] == [(6.0, 5.05), (20.0, 1.9)]
    assert {patch.radius for patch in ranges} == {1.3}


def test_snapshots_run_from_hand_off_to_end(result):
    times = figures.snapshot_times(result)
    assert times[0] == result.attrs["hand_off_time_s"]
    assert times[-1] == result.time.values[-1]
    assert np.all(np.diff(times) > 0)


def test_several_are_laid_over_each_other_and_have_a_range_only_where_it_is_that_of_all(result):
    axes = figures.paths([result, result])
    assert axes.get_legend_handles_labels()[1][:2] == ["line 1", "line 2"]
    assert any(not patch.fill for patch in axes.patches)
    axes = figures.paths({"near": result, "far": result.assign_attrs(sensing_range_m=2.0)})
    assert all(patch.fill for patch in axes.patches)


def test_no_result_is_refused():
    with pytest.raises(ValueError, match="no result"):
        figures.paths([])
