"""The map of modes and the root locus show the eigenvalues of the loop."""

import numpy as np
import pytest
from unstable import UNSTABLE

from drake_formation import load_scenario
from drake_formation.analysis import linearize, modes
from drake_formation.viz.analysis_modes import mode_map, root_locus

CASES = {
    "steel line": ("line", {"springs.stiffness": 3e4, "consensus.delta": 1e4}),
    "octagon": ("octagon", {"consensus.graph": "cycle", "consensus.delta": 1e4, "consensus.delta_v": 200.0}),
    "one robot": ("line", {"formation": {"shape": "line", "robots": 1, "side": 1.0}, "robots.start": [[0, 0]]}),
    "unstable": ("line", UNSTABLE),
    "overdamped": ("line", {"tracking.Q": [1.0, 1.0, 1601.0, 1601.0], "springs.graph": []}),
}


@pytest.fixture(params=CASES)
def formation(request):
    name, overrides = CASES[request.param]
    return linearize(load_scenario(name, overrides=overrides))


def points(axes):
    return np.array([point for line in axes.lines if line.get_linestyle() == "None" for point in line.get_xydata()])


def test_the_map_shows_every_mode_and_no_other(formation):
    found = modes(formation)
    axes = mode_map(found, "x")
    drawn = points(axes)
    expected = np.array([[mode.eigenvalue.real, mode.frequency] for mode in found.modes])
    order = [np.lexsort(part.T) for part in (drawn, expected)]
    np.testing.assert_allclose(drawn[order[0]], expected[order[1]])
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    assert np.all((expected[:, 0] > left) & (expected[:, 0] < right))
    assert np.all((expected[:, 1] > bottom) & (expected[:, 1] < top))
    assert axes.get_xlabel().endswith("(1/s)")


def test_open_markers_are_what_consensus_cannot_move(formation):
    axes = mode_map(modes(formation), "x")
    open_points = sum(len(line.get_xdata()) for line in axes.lines if line.get_fillstyle() == "none")
    assert open_points == sum(not mode.moved_by_consensus for mode in modes(formation).modes)


def test_the_locus_begins_without_consensus_and_passes_the_scenarios_gain(formation):
    axes = root_locus(formation)
    (dots,) = axes.collections[-1:]
    drawn = dots.get_offsets() @ [1, 1j]
    for delta in (0.0, 2e4):
        for value in np.linalg.eigvals(formation.closed_loop(delta, formation.delta_v)):
            if value.imag > 1e-9:
                assert np.abs(drawn - value).min() < 1e-6 * abs(value)
    rings = points(axes) @ [1, 1j]
    own = np.linalg.eigvals(formation.A)
    assert len(rings) == np.sum(own.imag >= -1e-9)
