"""A playback shows what was recorded, and moves between."""

import numpy as np
import pytest
from carrying import carried

from drake_formation import SimulationError, load_scenario, simulate
from drake_formation.viz.playback import Playback

MIXED = "{kind: {1: unicycle, 2: omnidirectional, default: point_mass}, start: {centre: [2, 3]}, heading: 30}"


@pytest.fixture(scope="module")
def result():
    return simulate(carried("{kind: lattice}", robots=MIXED), engine="blocks")


def test_at_its_samples_it_shows_what_they_are(result):
    playback, times = Playback(result), result.time.values
    np.testing.assert_allclose(playback.positions(times), result.position, atol=1e-12)
    np.testing.assert_allclose(playback.points(times)[:, 4:], result.object_nodes, atol=1e-12)
    np.testing.assert_allclose(playback.headings(times)[:, :2], result.heading[:, :2], atol=1e-12)
    np.testing.assert_array_equal(playback.carried(times), result.phase == 1)


def test_robots_without_a_heading_look_along_x(result):
    assert np.isnan(result.heading.values[:, 2:]).all()
    assert not Playback(result).headings(result.time.values)[:, 2:].any()


def test_the_first_sample_has_the_heading_and_the_grid_at_rest(result):
    np.testing.assert_allclose(result.heading[0, :2], np.radians(30))
    nodes = result.object_nodes.values[0].reshape(4, 4, 2)
    np.testing.assert_allclose(np.diff(nodes[..., 0], axis=1), 2 / 3)
    np.testing.assert_allclose(np.diff(nodes[..., 1], axis=0), 2 / 3)


@pytest.mark.slow
def test_compiled_runs_tell_the_same():
    scenario = carried("{kind: lattice, rows: 2, columns: 2}", robots=MIXED)
    blocks, compiled = (simulate(scenario, engine=engine) for engine in ("blocks", "compiled"))
    times = np.linspace(0.0, 1.8, 19)
    for name in ("points", "headings"):
        one, other = (getattr(Playback(result), name)(times) for result in (blocks, compiled))
        np.testing.assert_allclose(one, other, atol=1e-4)


def test_a_run_that_diverged_is_shown_until_its_robots_are_lost():
    unstable = {"simulator.integration_scheme": "explicit_euler", "simulator.use_error_control": False}
    with pytest.raises(SimulationError) as failure:
        simulate(load_scenario("line", overrides=unstable | {"consensus.delta": 1e4}))
    playback = Playback(failure.value.partial)
    assert playback.lost
    assert playback.begin < playback.end < failure.value.time
    assert np.abs(playback.positions(np.linspace(playback.begin, playback.end, 50))).max() < 1e3


@pytest.mark.parametrize("name", ["heading", "object_nodes"])
def test_a_result_of_before_it_told_what_is_to_be_seen_is_refused(result, name):
    with pytest.raises(ValueError, match=f"no {name}"):
        Playback(result.drop_vars(name))


def test_what_is_no_result_is_refused():
    result = simulate(load_scenario("line", overrides={"aggregation.duration": 0.0, "transport.duration": 0.2}))
    with pytest.raises(ValueError, match="position"):
        Playback(result.drop_vars("position"))
    with pytest.raises(ValueError, match="no sample"):
        Playback(result.isel(time=slice(0)))
