"""What the object resists: counted by the rigidity matrix, read off Drake's linearization, and seen in simulation."""

import numpy as np
import pytest
from hypothesis import given, settings
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.linear.linearization import linearize
from drake_formation.analysis.linear.motion_subspaces import spring_stiffness
from drake_formation.analysis.stability.held_shape import stiff_springs
from drake_formation.analysis.stability.rigidity import spring_linearization
from drake_formation.formation.rigidity import rigidity_matrix
from drake_formation.scenario import resolve


def springs_of(name="quadrilateral", **overrides):
    named = {path.replace("__", "."): value for path, value in overrides.items()}
    return spring_linearization(linearize(load_scenario(name, overrides=named)))


@given(scenario=scenarios())
@settings(max_examples=15)
def test_drakes_stiffness_is_the_rigidity_matrix_weighted(scenario):
    formation = linearize(scenario)
    edges = stiff_springs(formation.resolved)
    if not edges:
        with pytest.raises(IllPosedError, match="no springs"):
            spring_linearization(formation)
        return
    found = spring_linearization(formation)
    slots, count = resolve(scenario).slots, formation.robots
    stiffness = resolve(scenario).field("spring", "stiffness")
    stiffness = stiffness[stiffness > 0]
    lengths = rigidity_matrix(slots, edges).toarray()
    incidence = np.array([np.eye(count)[i] - np.eye(count)[j] for i, j in edges])
    exact = lengths.T @ np.diag(stiffness) @ lengths
    linear = np.kron(incidence.T @ np.diag(stiffness) @ incidence, np.eye(2))
    np.testing.assert_allclose(found.exact, exact, atol=1e-6 * stiffness.max())
    np.testing.assert_allclose(found.linear, linear, atol=1e-6 * stiffness.max())
    own = found.exact if scenario.springs.law == "hookean" else found.linear
    np.testing.assert_allclose(spring_stiffness(formation), own, atol=1e-6 * stiffness.max())
    assert np.linalg.eigvalsh(found.linear - found.exact)[0] > -1e-6 * stiffness.max()  # (5) only ever resists more


def test_a_spring_is_of_rank_one_and_the_papers_of_rank_two():
    found = springs_of("line", springs__stiffness=3e4)
    assert found.exact_free == 3
    assert found.linear_free == 2
    np.testing.assert_allclose(np.linalg.eigvalsh(found.exact), [0, 0, 0, 6e4], atol=1e-6)
    np.testing.assert_allclose(np.linalg.eigvalsh(found.linear), [0, 0, 6e4, 6e4], atol=1e-6)
    assert found.exact_rotation == pytest.approx(0, abs=1e-6)
    assert found.linear_rotation == pytest.approx(6e4)


@pytest.mark.parametrize(
    ("edges", "rank", "mechanisms"),
    [("complete", 5, 0), ("cycle", 4, 1), ("path", 3, 2), ([[1, 2], [2, 3], [3, 4], [1, 4], [1, 3]], 5, 0)],
)
def test_the_square_shears_without_a_diagonal(edges, rank, mechanisms):
    found = springs_of(springs__graph=edges)
    assert (found.rank, found.mechanisms, found.rigid) == (rank, mechanisms, mechanisms == 0)
    assert found.exact_free == 8 - rank  # the null space of Drake's matrix, counted a second way


def test_a_spring_without_stiffness_holds_nothing():
    values = [1.0, 1.0, 0.0, 1.0, 1.0, 1.0]  # edges 12 13 14 23 24 34
    assert springs_of(springs__stiffness=values).springs == 5


def test_robots_in_a_row_buckle():
    """Three robots in a line: their springs have rank 2, and the middle one may leave the line to first order."""
    overrides = {"formation": {"shape": "line", "robots": 3, "side": 1.0}, "robots.start": {"centre": [0, 0]}}
    found = spring_linearization(linearize(load_scenario("line", overrides=overrides)))
    assert (found.springs, found.rank, found.mechanisms) == (3, 2, 1)
