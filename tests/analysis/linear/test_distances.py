"""Consensus on distances, linearized: the rigidity matrix of its channels, and what is not answered for it."""

import numpy as np
import pytest
from hypothesis import given, settings
from strategies import scenarios

from drake_formation import load_scenario, with_overrides
from drake_formation.analysis import (
    IllPosedError,
    Questions,
    certify,
    cheapest_graph,
    linearize,
    modes,
    start_force,
    tune,
    velocity_gain,
)
from drake_formation.analysis.linear.motion_subspaces import positions, velocities
from drake_formation.formation.rigidity import rigidity_matrix

ON_DISTANCES = {"consensus.law": "hookean", "consensus.delta": 1e4, "springs.graph": []}


def on_distances(**overrides):
    named = {path.replace("__", "."): value for path, value in overrides.items()}
    return load_scenario("quadrilateral", overrides=ON_DISTANCES | named)


@given(scenario=scenarios())
@settings(max_examples=10)
def test_drakes_consensus_is_the_rigidity_matrix(scenario):
    formation = linearize(with_overrides(scenario, {"consensus.law": "hookean"}))
    resolved = formation.resolved
    lengths = rigidity_matrix(resolved.slots, resolved.channels.counted).toarray()
    weights = [resolved.channels.adjacency[edge] for edge in resolved.channels.counted]
    pull = -lengths.T @ np.diag(weights) @ lengths / np.repeat(resolved.masses, 2)[:, None]
    rows = velocities(formation.robots)
    for part, columns in ((formation.per_delta, positions(formation.robots)), (formation.per_delta_v, rows)):
        np.testing.assert_allclose(part[np.ix_(rows, columns)], pull, atol=1e-9)


@pytest.mark.parametrize(
    ("graph", "free"), [("complete", 0), ([[1, 2], [1, 4], [2, 3], [2, 4], [3, 4]], 0), ("cycle", 1)]
)
def test_what_it_leaves_free_is_left_to_the_local_lqr(graph, free):
    """Two translations, the rotation and every mechanism decay as one robot alone."""
    found = modes(linearize(on_distances(consensus__graph=graph)))
    left = [mode for mode in found.modes if not mode.moved_by_consensus]
    assert sum(mode.count for mode in left) == 3 + free


def test_its_certificate_says_what_it_is_not_asked_for():
    found = certify(on_distances(consensus__graph="cycle"), questions=Questions(consensus_error=1e-3))
    assert found.stable
    assert {"modes", "delay_margin_s", "disturbance", "rigidity"} <= set(found.to_dict())
    assert "on distances" in found.unanswered["design"]
    assert "on distances" in found.unanswered["topology"]
    assert found.sections["rigidity"].distances
    assert found.sections["rigidity"].channels.mechanisms == 1
    assert found.sections["delay_relative"].delay_s > 0


@pytest.mark.parametrize(
    "ask",
    [
        lambda formation: cheapest_graph(formation, error_bound_m=1.0),
        lambda formation: velocity_gain(formation, damping_ratio=0.7),
        lambda formation: tune(formation, effort_weight=1e-6),
        lambda formation: start_force(formation.scenario, formation=formation),
    ],
)
def test_what_assumes_displacements_is_refused(ask):
    with pytest.raises(IllPosedError, match="is for 'linear', on displacements"):
        ask(linearize(on_distances()))
