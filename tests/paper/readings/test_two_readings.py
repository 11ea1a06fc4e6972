"""The two readings: what they change of the shipped scenarios, and which cells set a parameter."""

from collections import Counter

import pytest

from drake_formation import load_scenario, with_overrides
from drake_formation.paper.published import published
from drake_formation.paper.readings.two_readings import PRINTED, PROBABLE, READINGS, Place
from drake_formation.paper.runs import ACCURATE, CASES, FORMATIONS, MATERIALS

CELLS = [
    Place(name, quantity, material, delta)
    for name, material, delta in CASES
    for quantity in published()[name]
    if quantity in ("tracking_error", "consensus_error", "peak_force")
    for _ in range(2 if (name, quantity) == ("line", "tracking_error") else 1)
]


@pytest.mark.parametrize("formation", FORMATIONS)
def test_as_printed_only_the_nearest_robot_feels_an_obstacle(formation):
    run = PRINTED.transport(formation, "rubber", 0.0)
    assert run == load_scenario(formation, overrides=ACCURATE | {"avoidance.sensing": "nearest"})


@pytest.mark.parametrize("formation", FORMATIONS)
def test_as_probably_simulated_robots_objects_and_obstacles_are_the_same(formation):
    printed, probable = (reading.transport(formation, "steel", 1e4) for reading in READINGS.values())
    assert printed.avoidance.obstacles == probable.avoidance.obstacles
    for part in ("formation", "springs", "tracking", "transport"):
        assert getattr(printed, part) == getattr(probable, part)
    assert probable.robots.mass == printed.robots.mass


def test_cells_that_set_a_parameter_are_counted_apart():
    assert len(CELLS) == 54
    assert Counter(filter(None, map(PRINTED.set_by, CELLS))) == {"η": 1, "D": 4, "T_agg": 14, "octagon": 1}
    assert Counter(filter(None, map(PROBABLE.set_by, CELLS))) == {
        "η": 1, "D": 4, "T_agg": 12, "octagon": 1, "who feels": 5,
    }  # fmt: skip


def test_a_topology_changes_the_graph_alone():
    for reading in READINGS.values():
        complete = reading.transport("quadrilateral", "rubber", 2e4)
        assert with_overrides(reading.topology("8 channels (cycle)"), {"consensus.graph": "complete"}) == complete


def test_materials_are_the_published_ones():
    assert published()["materials"] == MATERIALS
