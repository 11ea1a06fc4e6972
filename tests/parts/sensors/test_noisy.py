"""Sensors with noise, bias and dropouts."""

import numpy as np
import pytest
from tracking_loops import alone, two

from drake_formation import ScenarioError, simulate, with_overrides
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.parts.sensors.noisy import STREAMS, measured_state
from drake_formation.simulation.run import PreparedRun
from drake_formation.systems.random_stream import random_start

STATE = [1.0, -2.0, 0.3, 0.4]


def seen(scenario, **sensor):
    """The scenario with noisy sensors."""
    return with_overrides(scenario, {"sensor": {"kind": "noisy", **sensor}})


def samples(count, noise, bias=(0.0, 0.0, 0.0, 0.0)):
    """What a sensor shows of a state at some samples, shape (count, 4)."""
    generators = np.concatenate([random_start(1, name) for name in STREAMS]).tolist()
    shown, found = STATE, []
    for _ in range(count):
        shown, generators = measured_state(STATE, shown, generators, list(noise), list(bias))
        found.append(shown)
    return np.array(found)


def test_noise_has_its_deviations_and_bias_and_no_memory():
    bias = [0.5, -0.5, 0.1, 0.2]
    noise = samples(4000, [0.1, 0.02, 0.0], bias) - STATE
    np.testing.assert_allclose(noise.std(axis=0), [0.1, 0.1, 0.02, 0.02], rtol=0.05)
    np.testing.assert_allclose(noise.mean(axis=0), bias, atol=0.01)
    np.testing.assert_allclose(np.corrcoef(noise.T), np.eye(4), atol=0.05)
    assert abs(np.corrcoef(noise[1:, 0], noise[:-1, 0])[0, 1]) < 0.05


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_lost_samples_leave_what_was_shown(share):
    found = samples(4000, [0.1, 0.1, share])
    kept = (np.diff(found, axis=0) == 0.0).all(axis=1).mean()
    assert kept == pytest.approx(share, abs=0.03)


def test_a_sensor_that_lacks_nothing_changes_nothing():
    plain, perfect = (simulate(scenario) for scenario in (two(), seen(two(), period=None)))
    np.testing.assert_array_equal(perfect["position"], plain["position"])
    np.testing.assert_array_equal(perfect["measured_velocity"], perfect["velocity"])


def test_a_bias_moves_the_robot_and_not_what_is_recorded_of_it():
    bias = [0.3, -0.2]
    result = simulate(seen(alone(duration=90.0), period=None, position_bias=bias))
    np.testing.assert_allclose(result["position"].values[-1, 0], -np.array(bias), atol=1e-3)
    np.testing.assert_allclose(result["tracking_error"], result["position"], atol=1e-12)
    np.testing.assert_allclose(
        (result["measured_position"] - result["position"]).values[:, 0], [bias] * len(result.time)
    )


def test_robots_tell_each_other_what_they_see():
    """Biases that are alike cancel between robots, one alone does not."""
    coupled, delta = with_overrides(two(duration=0.1), {"consensus.delta": 100.0}), 100.0
    one = {"1": [0.3, 0.0], "default": [0.0, 0.0]}
    none, alike, different = (
        simulate(seen(coupled, period=None, position_bias=bias))["consensus_force"].values[0]
        for bias in ([0.0, 0.0], [0.3, 0.0], one)
    )
    np.testing.assert_allclose(alike, none, atol=1e-9)
    np.testing.assert_allclose(different - none, [[-0.3 * delta, 0.0], [0.3 * delta, 0.0]], atol=1e-9)


def test_one_seed_gives_the_same_noise_in_every_engine_and_whoever_else_has_noise():
    noise = {"period": 0.1, "position_noise": 0.01, "velocity_noise": 0.01, "dropout": 0.2}
    scenario = seen(two(duration=1.0), **noise)
    blocks, compiled, reseeded = (
        simulate(variant, engine=engine)
        for variant, engine in (
            (scenario, "blocks"), (scenario, "compiled"), (with_overrides(scenario, {"seed": 1}), "blocks"),
        )
    )  # fmt: skip
    last = [run["measured_position"].values[-1] for run in (blocks, compiled, reseeded)]
    np.testing.assert_allclose(last[0], last[1], rtol=0, atol=1e-9)
    assert (last[0] != last[2]).all()
    first_only = {"1": "noisy", "default": "ideal"}
    single = simulate(with_overrides(scenario, {"sensor": {**noise, "kind": first_only}}), engine="blocks")
    early = [run.sel(time=0.05, method="nearest") for run in (blocks, single)]
    drawn = [(run["measured_position"] - blocks["position"][0])[0] for run in early]
    np.testing.assert_array_equal(drawn[0], drawn[1])
    np.testing.assert_array_equal(single["measured_position"][:, 1], single["position"][:, 1])


def test_a_prepared_run_begins_with_the_noise_of_each_seed():
    scenario = seen(two(duration=0.3), period=0.1, position_noise=0.01)
    prepared, reseeded = PreparedRun(scenario, engine="blocks"), with_overrides(scenario, {"seed": 1})
    for variant in (reseeded, scenario):
        alone_run = simulate(variant, engine="blocks")
        np.testing.assert_array_equal(prepared.run(variant)["measured_position"], alone_run["measured_position"])


def test_the_response_without_obstacles_has_the_same_noise():
    far = {"avoidance.obstacles": [{"position": [900.0, 900.0]}], "aggregation.duration": 0.3}
    scenario = with_overrides(seen(two(duration=0.5), period=0.1, position_noise=0.05), far)
    for engine in ("blocks", "compiled"):
        deviation = simulate(scenario, engine=engine)["deviation"].values
        assert np.nanmax(np.abs(deviation)) < 1e-9


def test_the_analysis_refuses_it_by_name():
    with pytest.raises(IllPosedError, match="robot 1 has sensor 'noisy' of drake-formation"):
        linearize(seen(two()))


@pytest.mark.parametrize(
    ("sensor", "message"),
    [
        ({"period": 0.0}, r"sensor.period: out of range \(got 0.0"),
        ({"position_noise": -0.1}, r"sensor.position_noise: out of range \(got -0.1"),
        ({"dropout": 1.5}, r"sensor.dropout: out of range \(got 1.5"),
        ({"period": None, "dropout": 0.5}, r"sensor.dropout: drawn anew for every sample.* or also a period"),
    ],
)
def test_bad_sensors_are_refused_with_the_place(sensor, message):
    with pytest.raises(ScenarioError, match=message):
        seen(two(), **sensor)
