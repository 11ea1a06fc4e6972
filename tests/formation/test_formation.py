"""A resolved formation answers for its robots, edges and times."""

import numpy as np
import pytest

from drake_formation import load_scenario
from drake_formation.scenario import resolve, shipped_scenarios

MASSES = {"robots.mass": {"1": 20.0, "default": 30.0}, "springs.stiffness": {"1-3": 7.0, "default": 5.0}}


@pytest.mark.parametrize("name", shipped_scenarios())
def test_slots_are_about_the_centre_and_starts_about_where_it_gathers(name):
    formation = resolve(load_scenario(name))
    np.testing.assert_allclose(formation.slots.mean(axis=0), 0, atol=1e-12)
    np.testing.assert_allclose(formation.starts.mean(axis=0), formation.centre, atol=1e-12)
    assert formation.radius == pytest.approx(np.linalg.norm(formation.slots, axis=1).max())


@pytest.mark.parametrize("name", shipped_scenarios())
def test_there_is_a_part_for_every_owner(name):
    formation = resolve(load_scenario(name))
    counts = {
        "spring": len(formation.springs.pairs),
        "channel": len(formation.channels.pairs),
        "reference": 1,
        "object": 1,
        "medium": 1,
    }
    for role, parts in formation.parts.items():
        assert len(parts) == counts.get(role, formation.robots)
        assert all(part.role == role for part in parts)


def test_each_robot_and_edge_has_its_own_numbers():
    formation = resolve(load_scenario("quadrilateral", overrides=MASSES))
    np.testing.assert_array_equal(formation.masses, [20.0, 30.0, 30.0, 30.0])
    pairs = map(tuple, formation.springs.pairs.tolist())
    stiffness = dict(zip(pairs, formation.field("spring", "stiffness"), strict=True))
    assert stiffness.pop((0, 2)) == 7.0
    assert set(stiffness.values()) == {5.0}


def test_a_displacement_is_the_difference_of_slots():
    formation = resolve(load_scenario("quadrilateral"))
    away = formation.displacements(1, (0, 3))
    np.testing.assert_array_equal(away, formation.slots[1] - formation.slots[[0, 3]])
    assert formation.rest_lengths == pytest.approx(formation.springs.lengths(formation.slots))


def test_what_is_kept_is_kept_by_one_formation_alone():
    formation = resolve(load_scenario("line"))
    formation.kept["mark"] = 1
    assert "mark" not in formation.changed(begin=1.0).kept
    assert formation.changed(begin=1.0).hand_off == formation.hand_off + 1.0
