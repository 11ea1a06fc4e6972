"""Transports that begin at a hand-off."""

from dataclasses import replace

import numpy as np
import pytest

from drake_formation import simulate
from drake_formation.paper.readings.simulated import SIMULATED, changed, hand_off, handed_over, passes
from drake_formation.paper.runs import aggregation, shipped
from drake_formation.scenario import resolve, with_overrides

GATHERED = (5.0, 3.0)


def test_a_transport_begins_where_the_aggregation_ends():
    gathering = with_overrides(
        aggregation("line", GATHERED[0]), {"aggregation.duration": 3.0, "transport.duration": 0.5}
    )
    result = simulate(gathering, engine="compiled")
    end = result.isel(time=int(np.argmax(result["phase"].values == 1)))
    scenario = handed_over("line", replace(SIMULATED["line"], duration=3.0), "rubber", 0.0)
    begin = simulate(with_overrides(scenario, {"transport.duration": 0.1})).isel(time=0)
    for variable in ("position", "velocity"):
        np.testing.assert_allclose(begin[variable], end[variable], atol=1e-12)
    assert begin["phase"] == 1


def test_all_cells_of_a_formation_begin_alike():
    runs = [
        handed_over("line", SIMULATED["line"], material, delta)
        for material in ("rubber", "steel")
        for delta in (0, 1e4)
    ]
    assert all(run.robots == runs[0].robots for run in runs)


def test_a_hand_off_depends_on_the_gain_of_the_gathering():
    line = shipped("line")
    assert hand_off(line, *GATHERED)["robots.start"] != hand_off(line, 0.0, 3.0)["robots.start"]


def test_the_robot_that_feels_an_obstacle_passes_it_nearest():
    for name, settings in SIMULATED.items():
        formation = resolve(handed_over(name, settings, "rubber", 0.0))
        height = formation.goal[1] + formation.slots[:, 1]
        for (_, y), robot in zip(formation.obstacles.middles, settings.assigned, strict=True):
            away = np.abs(height - y)
            assert away[robot - 1] == pytest.approx(away.min())


def test_how_near_robots_pass():
    """The square's upper robots at y = 4.0125 m, an obstacle at 5.05 m."""
    np.testing.assert_allclose(passes(resolve(shipped("quadrilateral")))[[0, 3], 0], 5.05 - 4.0125)


def test_settings_change_for_all_or_by_formation():
    both = changed(range=2.0, law={"line": "a", "quadrilateral": "b", "octagon": "c"})
    assert [(its.range, its.law) for its in both.values()] == [(2.0, "a"), (2.0, "b"), (2.0, "c")]
    assert both["line"].duration == SIMULATED["line"].duration
