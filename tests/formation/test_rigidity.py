"""Known frameworks: what distances hold, and how many are needed."""

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.formation import graphs, shapes
from drake_formation.formation.rigidity import rigid_rank, rigidity, rigidity_matrix, rigidity_rank

TRUSS = [(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)]


@pytest.mark.parametrize(("edges", "rank"), [(TRUSS, 5), (TRUSS[:4], 4), ([*TRUSS, (1, 3)], 5), ([], 0)])
def test_a_square_is_rigid_with_a_diagonal(edges, rank):
    square = shapes.polygon(4, 1.0, None)
    assert rigidity_rank(square, edges) == rank
    assert rigid_rank(4) == 5


def test_robots_in_a_row_are_not_rigid_however_they_are_linked():
    row = shapes.line(3, 1.0, 0.0)
    assert rigidity_rank(row, [(0, 1), (0, 2), (1, 2)]) == 2 < rigid_rank(3)


@given(st.integers(3, 12))
def test_polygons_are_rigid_when_all_talk_and_lose_rank_at_once_as_a_cycle(robots):
    slots = shapes.polygon(robots, 1.0, None)
    assert rigidity_rank(slots, graphs.edges(nx.complete_graph(robots))) == rigid_rank(robots)
    assert rigidity_rank(slots, graphs.edges(nx.cycle_graph(robots))) == robots


@given(st.integers(2, 8), st.integers(0, 2**32 - 1))
def test_translations_and_the_rotation_change_no_distance(robots, seed):
    slots = np.random.default_rng(seed).uniform(-1, 1, (robots, 2))
    matrix = rigidity_matrix(slots, graphs.edges(nx.complete_graph(robots))).toarray()
    moves = np.stack([slots * 0 + [1, 0], slots * 0 + [0, 1], slots[:, ::-1] * [-1, 1]]).reshape(3, -1)
    np.testing.assert_allclose(matrix @ moves.T, 0, atol=1e-12)


def test_a_long_braced_beam_is_rigid():
    """Its softest bending is a millionth of a strut's stiffness and less; rounding is not."""
    slots = shapes.grid(2, 100, 1.0)
    beam = [(i, i + 1) for i in range(199) if i != 99] + [(i, i + 100) for i in range(100)]
    braces = [(i, i + 101) for i in range(99)]
    assert rigidity_rank(slots, beam + braces) == rigid_rank(200)
    assert rigidity_rank(slots, beam + braces[1:]) == rigid_rank(200) - 1


@given(st.integers(3, 8), st.integers(0, 2**32 - 1))
def test_what_rigidity_says_is_what_the_matrix_does(robots, seed):
    rng = np.random.default_rng(seed)
    slots = rng.uniform(-1, 1, (robots, 2))
    edges = graphs.edges(nx.gnm_random_graph(robots, int(rng.integers(1, robots * (robots - 1) // 2 + 1)), seed=seed))
    found, matrix = rigidity(slots, edges), rigidity_matrix(slots, edges).toarray()
    assert found.rank == np.linalg.matrix_rank(matrix, tol=1e-6) <= found.generic_rank
    assert found.rigid == (found.mechanisms == 0) == (found.softest > 0)
    if found.rigid:
        values = np.linalg.svd(matrix, compute_uv=False)
        assert found.softest == pytest.approx(values[found.needed - 1] ** 2)
        assert found.edges >= found.needed


def test_two_robots_are_held_by_their_distance_and_one_by_none():
    pair = rigidity(shapes.line(2, 1.0, 0.0), [(0, 1)])
    assert pair.minimally_rigid
    assert pair.softest == pytest.approx(2.0)
    assert rigidity(np.zeros((1, 2)), []).rigid
