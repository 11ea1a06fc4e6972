"""The parts of a formation's motion: an orthogonal split that the springs respect."""

import numpy as np
from hypothesis import given, settings
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis.linear.linearization import linearize
from drake_formation.analysis.linear.motion_subspaces import parts, spring_damping, spring_stiffness
from drake_formation.analysis.stability.held_shape import stiff_springs
from drake_formation.formation.rigidity import rigidity_matrix
from drake_formation.scenario import resolve


@given(scenario=scenarios())
@settings(max_examples=15)
def test_parts_split_all_displacements(scenario):
    split = parts(linearize(scenario))
    whole = np.hstack(list(split.values()))
    np.testing.assert_allclose(whole.T @ whole, np.eye(len(whole)), atol=1e-9)
    assert split["centre"].shape[1] == 2
    assert split["rotation"].shape[1] == (len(whole) > 2)


@given(scenario=scenarios())
@settings(max_examples=15)
def test_springs_resist_stretch_alone(scenario):
    formation = linearize(scenario)
    split = parts(formation)
    matrices = [spring_stiffness(formation), spring_damping(formation)]
    free = ["centre", "consensus"] + ["rotation"] * (scenario.springs.law == "hookean")
    for matrix in matrices:
        for part in free:
            np.testing.assert_allclose(matrix @ split[part], 0, atol=1e-6 * max(1.0, np.abs(matrix).max()))
    stretch = split["stretch"]
    if stretch.shape[1]:
        assert np.linalg.eigvalsh(stretch.T @ sum(matrices) @ stretch)[0] > 0
    if scenario.springs.law == "hookean":
        rows = rigidity_matrix(resolve(scenario).slots, stiff_springs(formation.resolved)).toarray()
        assert len(rows) == 0 or stretch.shape[1] >= np.linalg.matrix_rank(rows, tol=1e-9)


def test_masses_do_not_change_the_objects_stiffness():
    alike, unlike = (
        linearize(load_scenario("quadrilateral", overrides={"robots.mass": mass}))
        for mass in (40.0, [10.0, 20.0, 30.0, 40.0])
    )
    np.testing.assert_allclose(spring_stiffness(alike), spring_stiffness(unlike), atol=1e-9)
