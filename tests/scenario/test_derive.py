import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from drake_formation.formation import shapes
from drake_formation.scenario import derive, load_scenario, with_overrides
from drake_formation.scenario.schema import Grid, Polygon, RandomBox, RandomStart, Scenario, Slots

LINE = load_scenario("line")
OCTAGON = load_scenario("octagon")


def random_start(count, seed, about, spread):
    robots = LINE.robots.model_copy(
        update={"start": RandomStart(random=RandomBox(seed=seed, about=about, spread=spread))}
    )
    return LINE.model_copy(update={"formation": Polygon(shape="polygon", robots=count, side=1.0), "robots": robots})


@given(st.from_type(Scenario))
def test_every_robot_has_a_slot(scenario):
    shape = scenario.formation
    if isinstance(shape, Polygon):
        assume((shape.side is None) != (shape.width is None))
        assume(shape.width is None or shape.robots in (4, 6))
    assert derive.slots(scenario).shape == (derive.robot_count(shape), 2)


def test_the_number_of_robots_of_each_shape():
    assert derive.robot_count(LINE.formation) == 2
    assert derive.robot_count(OCTAGON.formation) == 8
    assert derive.robot_count(Grid(shape="grid", rows=2, columns=3, side=1.0)) == 6
    assert derive.robot_count(Slots(shape="slots", slots=[(0, 0), (1, 2)])) == 2


def test_slots_follow_the_shape():
    assert_array_equal(derive.slots(LINE), shapes.line(2, 1.0))
    assert_array_equal(derive.slots(OCTAGON), shapes.polygon(8, np.tan(np.pi / 8)))
    given_slots = with_overrides(LINE, {"formation": {"shape": "slots", "slots": [[0, 0], [1, 2]]}})
    assert_array_equal(derive.slots(given_slots), [[0, 0], [1, 2]])
    grid = with_overrides(LINE, {"formation": {"shape": "grid", "rows": 1, "columns": 2, "side": 2}})
    assert_array_equal(derive.slots(grid), [[-1, 0], [1, 0]])


def test_a_polygon_needs_one_measure():
    for measures in ({}, {"side": 1.0, "width": 1.0}):
        with pytest.raises(ValueError, match="either side or width"):
            derive.polygon_side(Polygon(shape="polygon", robots=4, **measures))


@given(
    st.integers(2, 30),
    st.integers(min_value=0),
    st.tuples(st.floats(-100, 100), st.floats(-100, 100)),
    st.floats(0.1, 10),
)
def test_random_starts_are_reproducible_and_centred(count, seed, about, spread):
    scenario = random_start(count, seed, about, spread)
    starts = derive.starts(scenario)
    assert_allclose(starts.mean(axis=0), about, atol=1e-12, rtol=0)
    assert_array_equal(starts, derive.starts(scenario))
    assert np.abs(starts - about).max() <= 2 * spread
    assert not np.array_equal(starts, derive.starts(random_start(count, seed + 1, about, spread)))


def test_starts_in_formation_and_from_a_list():
    assert_array_equal(derive.starts(LINE), [[4, 5], [1, 2]])
    gathered = with_overrides(LINE, {"robots.start": {"centre": [2, 3]}})
    assert_allclose(derive.starts(gathered), np.array([2, 3]) + derive.slots(LINE))


def test_the_published_aggregation_ends_at_the_published_finals():
    assert_allclose(derive.aggregation_centre(LINE) + derive.slots(LINE), [[2.5, 3], [2.5, 4]])


def test_the_goal_of_the_octagon_is_25_m_ahead():
    assert_allclose(OCTAGON.transport.goal - derive.aggregation_centre(OCTAGON), [25, 0], atol=1e-12)
