import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from drake_formation.formation import shapes

counts = st.integers(2, 40)
sides = st.floats(0.01, 100)
headings = st.floats(-720, 720)


def steps(slots):
    """Distances from each slot to the next."""
    return np.linalg.norm(np.diff(slots, axis=0), axis=1)


@given(counts, sides, headings)
def test_a_line_is_centred_evenly_spaced_and_heads_where_asked(robots, side, heading):
    slots = shapes.line(robots, side, heading)
    assert_allclose(slots.mean(axis=0), 0, atol=1e-12 * side * robots)
    assert_allclose(steps(slots), side)
    direction = np.array([np.cos(np.radians(heading)), np.sin(np.radians(heading))])
    assert_allclose(slots[-1] - slots[0], (robots - 1) * side * direction, atol=1e-10 * side * robots)


@given(counts, sides, st.none() | headings)
def test_a_polygon_is_centred_with_equal_sides(robots, side, heading):
    slots = shapes.polygon(robots, side, heading)
    assert_allclose(slots.mean(axis=0), 0, atol=1e-12 * side * robots)
    assert_allclose(steps(np.vstack([slots, slots[:1]])), side, rtol=1e-9)
    assert_allclose(np.linalg.norm(slots, axis=1), np.linalg.norm(slots[0]))


@given(st.integers(3, 40), sides, headings)
def test_a_polygon_is_numbered_counter_clockwise_from_its_heading(robots, side, heading):
    slots = shapes.polygon(robots, side, heading)
    x, y = slots[0] / np.linalg.norm(slots[0])
    assert_allclose([x, y], [np.cos(np.radians(heading)), np.sin(np.radians(heading))], atol=1e-10)
    nexts = np.roll(slots, -1, axis=0)
    assert (slots[:, 0] * nexts[:, 1] - slots[:, 1] * nexts[:, 0] > 0).all()


@given(st.integers(3, 40), sides)
def test_by_default_the_first_robot_is_the_left_end_of_a_level_top_edge(robots, side):
    slots = shapes.polygon(robots, side)
    first, last = slots[0], slots[-1]
    assert_allclose(first[1], last[1], atol=1e-10 * side * robots)
    assert_allclose(first[1], slots[:, 1].max(), atol=1e-10 * side * robots)
    assert first[0] < last[0]


@given(st.integers(2, 20).map(lambda half: 2 * half), sides)
def test_the_width_of_a_polygon_is_measured_across_its_flats(robots, width):
    slots = shapes.polygon(robots, shapes.side_from_width(robots, width))
    assert_allclose(np.ptp(slots[:, 1]), width, rtol=1e-9)


@pytest.mark.parametrize("robots", [2, 3, 7])
def test_no_width_without_parallel_sides(robots):
    with pytest.raises(ValueError, match="no two parallel sides"):
        shapes.side_from_width(robots, 1.0)


@given(st.integers(1, 8), st.integers(1, 8), sides)
def test_a_grid_is_centred_and_evenly_spaced_row_by_row(rows, columns, side):
    slots = shapes.grid(rows, columns, side).reshape(rows, columns, 2)
    assert_allclose(slots.mean(axis=(0, 1)), 0, atol=1e-12 * side * rows * columns)
    assert_allclose(np.diff(slots[..., 0], axis=1), side)
    assert_allclose(np.diff(slots[..., 1], axis=0), -side)
    assert_array_equal(slots[0, :, 1], np.full(columns, slots[..., 1].max()))


def test_axes_are_met_exactly():
    assert_array_equal(shapes.line(2, 1.0, 90.0), [[0, -0.5], [0, 0.5]])
    assert_array_equal(shapes.line(2, 1.0, -180.0), [[0.5, 0], [-0.5, 0]])


def test_the_square_is_numbered_as_the_paper_does():
    assert_allclose(shapes.polygon(4, 1.0), [[-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5], [0.5, 0.5]])


def test_one_robot_stands_in_the_centre():
    assert_array_equal(shapes.line(1, 1.0), [[0, 0]])
    assert_array_equal(shapes.grid(1, 1, 1.0), [[0, 0]])
