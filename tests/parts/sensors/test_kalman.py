"""The Kalman filter: its gain and covariance against the Riccati equation, and what a robot knows by it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import solve_discrete_are
from tracking_loops import alone, two

from drake_formation import ScenarioError, simulate, with_overrides
from drake_formation.analysis import IllPosedError, linearize
from drake_formation.parts.sensors.kalman import corrected, next_covariance, predicted, steady_gain

periods, noises = st.floats(0.01, 0.5), st.floats(0.01, 1.0)


def filtered(scenario, **sensor):
    """The scenario with robots that measure positions alone."""
    return with_overrides(scenario, {"sensor": {"kind": "kalman", **sensor}})


def by_riccati(period, position_noise, acceleration_noise):
    """Gain and covariance in the steady state, from SciPy's solution for the covariance of the prediction."""
    a, c, push = np.array([[1.0, period], [0.0, 1.0]]), np.array([[1.0, 0.0]]), np.array([period**2 / 2, period])
    ahead = solve_discrete_are(a.T, c.T, acceleration_noise**2 * np.outer(push, push), [[position_noise**2]])
    gain = ahead @ c.T / (c @ ahead @ c.T + position_noise**2)
    return gain.ravel(), (np.eye(2) - gain @ c) @ ahead


@given(periods, noises, noises)
@settings(max_examples=20, deadline=None)
def test_the_steady_gain_is_the_riccati_equations(period, position_noise, acceleration_noise):
    expected, _ = by_riccati(period, position_noise, acceleration_noise)
    np.testing.assert_allclose(steady_gain(period, position_noise, acceleration_noise), expected, rtol=1e-6)


def test_the_gain_is_the_alpha_beta_filters():
    """Kalata (1984), at a tracking index σ_a T²/σ_q of 1: α = 3/4 and β = 1/2."""
    assert steady_gain(2.0, 4.0, 1.0) == pytest.approx((0.75, 0.5 / 2.0), rel=1e-12)


@given(periods, noises, noises)
@settings(max_examples=10, deadline=None)
def test_the_covariance_settles_at_the_riccati_equations(period, position_noise, acceleration_noise):
    covariance = [0.0, 0.0, 0.0]
    for _ in range(3000):
        gain, covariance = next_covariance(covariance, period, position_noise, acceleration_noise)
    expected_gain, expected = by_riccati(period, position_noise, acceleration_noise)
    np.testing.assert_allclose(covariance, expected[[0, 0, 1], [0, 1, 1]], rtol=1e-6)
    np.testing.assert_allclose(gain, expected_gain, rtol=1e-6)


def test_errors_have_the_covariance_that_the_filter_takes_them_to_have():
    """Many robots that unknown accelerations push from sample to sample, each with a filter."""
    rng, period, noise, pushed = np.random.default_rng(1), 0.1, 0.05, 2.0
    gain, expected = by_riccati(period, noise, pushed)
    state, estimate, force = np.zeros((2, 4, 20_000))[0], list(np.zeros((4, 20_000))), [3.0, -1.0]
    for _ in range(100):
        unknown = rng.normal(0.0, pushed, (2, state.shape[1]))
        state = np.array(predicted(list(state), [40.0 * unknown[k] + force[k] for k in (0, 1)], 40.0, period))
        measured = [state[k] + rng.normal(0.0, noise, state.shape[1]) for k in (0, 1)]
        estimate = corrected(predicted(estimate, force, 40.0, period), measured, gain)
    error = np.array(estimate) - state
    np.testing.assert_allclose(np.cov(error[[0, 2]]), expected, rtol=0.05)
    np.testing.assert_allclose(np.cov(error[[1, 3]]), expected, rtol=0.05)


@pytest.mark.parametrize("gain", ["steady", "time_varying"])
@pytest.mark.parametrize("begin", [0.0, 0.73])
def test_a_robot_whose_force_is_known_and_positions_are_exact_knows_its_velocity_from_the_start(gain, begin):
    sensor = {"period": 0.1, "position_noise": 1e-6, "acceleration_noise": 1e-3, "gain": gain}
    moving = {"robots.velocity": [0.4, -0.2], "simulator.start_time": begin}
    scenario = with_overrides(filtered(alone(duration=2.0), **sensor), moving)
    result = simulate(scenario)
    held = result.sel(time=begin + np.arange(0.05, 2.0, 0.1), method="nearest")
    np.testing.assert_allclose(held["measured_velocity"], held["velocity"], atol=0.06)
    # What is shown is as old as the sample; the samples themselves are exact.
    ticks = np.ceil(begin / 0.1) * 0.1 + 0.1 * np.arange(19)
    now, after = (result.sel(time=ticks + ahead, method="nearest") for ahead in (0.0, 0.1))
    np.testing.assert_allclose(after["measured_velocity"].values, now["velocity"].values, atol=2e-4)


@pytest.mark.slow
def test_engines_draw_and_filter_alike():
    scenario = filtered(two(duration=1.0), period=0.05, gain={"1": "steady", "2": "time_varying"})
    found, blocks = (simulate(scenario, engine=name) for name in ("compiled", "blocks"))
    np.testing.assert_allclose(found["position"][-1], blocks["position"][-1], rtol=0, atol=1e-6)
    np.testing.assert_allclose(found["measured_velocity"][-1], blocks["measured_velocity"][-1], rtol=0, atol=1e-5)


def test_the_analysis_refuses_it_by_name():
    with pytest.raises(IllPosedError, match="robot 1 has sensor 'kalman' of drake-formation"):
        linearize(filtered(two()))


@pytest.mark.parametrize(
    ("sensor", "message"),
    [
        ({"period": 0.0}, r"sensor.period: out of range \(got 0.0"),
        ({"position_noise": 0.0}, r"sensor.position_noise: out of range \(got 0.0"),
        ({"gain": "best"}, r"sensor.gain: .*steady, time_varying"),
    ],
)
def test_bad_filters_are_refused_with_the_place(sensor, message):
    with pytest.raises(ScenarioError, match=message):
        filtered(two(), **sensor)
