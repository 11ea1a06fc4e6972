import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm, solve_discrete_are
from strategies import cost, generators
from tracking_loops import START, apart, path, two

from drake_formation import ScenarioError
from drake_formation.analysis import IllPosedError, certify
from drake_formation.parts.tracking.lqr import lqr_gain, robot_matrices
from drake_formation.parts.tracking.lqr_discrete import lqr_discrete_gain, sampled_matrices

masses, periods = st.floats(0.1, 1000), st.floats(0.01, 1.0)


@given(masses, periods)
def test_the_sampled_robot_is_the_exponential_of_the_continuous_one(mass, period):
    a, b = robot_matrices(mass)
    whole = expm(period * np.block([[a, b], [np.zeros((2, 6))]]))
    found = np.hstack(sampled_matrices(mass, period))
    np.testing.assert_allclose(found, whole[:4], rtol=1e-12, atol=1e-15)


@given(masses, periods, generators)
@settings(max_examples=30)
def test_gain_solves_the_discrete_riccati_equation_and_stabilizes(mass, period, rng):
    a, b = sampled_matrices(mass, period)
    q, r = np.array(cost(rng, 4, isotropic=False)), np.array(cost(rng, 2, isotropic=False))
    p = solve_discrete_are(a, b, q, r)
    expected = np.linalg.solve(r + b.T @ p @ b, b.T @ p @ a)
    found = lqr_discrete_gain(mass, period, q, r)
    np.testing.assert_allclose(found, expected, rtol=1e-5, atol=1e-5 * abs(expected).max())
    assert np.abs(np.linalg.eigvals(a - b @ found)).max() < 1


def test_for_short_periods_the_gain_becomes_the_continuous_one():
    q, r = np.diag([3.0, 2.0, 1.0, 1.0]), np.eye(2)
    expected = lqr_gain(40.0, q, r)
    errors = [np.abs(lqr_discrete_gain(40.0, period, q, r) - expected).max() for period in (0.1, 0.01, 0.001)]
    np.testing.assert_allclose(np.divide(errors[:-1], errors[1:]), 10.0, rtol=0.1)


@pytest.mark.parametrize("engine", ["blocks", "compiled", "exponential"])
def test_at_its_samples_the_robot_is_where_the_discrete_loop_takes_it(engine):
    period, weights = 0.25, {"Q": 1e4, "R": 1.0}
    times, position = path(engine, kind="lqr_discrete", period=period, **weights)
    a, b = sampled_matrices(40.0, period)
    loop = a - b @ lqr_discrete_gain(40.0, period, 1e4 * np.eye(4), np.eye(2))
    state = np.concatenate([START, np.zeros(2)])
    for k in range(12):
        (sample,) = np.flatnonzero(np.isclose(times, k * period, rtol=0, atol=1e-12))
        np.testing.assert_allclose(position[sample], state[:2], rtol=0, atol=1e-7)
        state = loop @ state


def test_for_short_periods_the_run_becomes_the_continuous_one():
    """By the square of the period: holding the force delays it, and the design makes up for that."""
    case = {"Q": [1e4, 1e4, 1.0, 1.0], "duration": 1.0}
    _, expected = path(kind="lqr", **case)
    errors = [
        np.abs(path(kind="lqr_discrete", period=period, **case)[1][-1] - expected[-1]).max()
        for period in (0.1, 0.05, 0.025)
    ]
    assert errors[0] > 1e-3
    np.testing.assert_allclose(np.divide(errors[:-1], errors[1:]), 4.0, rtol=0.1)


@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    assert apart(engine, kind="lqr_discrete", period=0.05, Q=100.0, feed_forward=True) < 1e-4


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"period": 0.0}, "tracking.period: out of range"),
        ({"Q": [0.0, 1.0, 1.0, 1.0]}, "tracking.Q: a position costs nothing"),
        ({"R": -1.0}, "tracking.R: not positive definite"),
        ({"Q": 1e-300, "R": 1e300}, "tracking: Drake finds no stabilizing gain"),
    ],
)
def test_what_gives_no_controller_is_refused(fields, message):
    with pytest.raises(ScenarioError, match=message):
        two(kind="lqr_discrete", **fields)


def test_the_analysis_refuses_it_by_name():
    with pytest.raises(IllPosedError, match="tracking 'lqr_discrete' of drake-formation"):
        certify(two(kind="lqr_discrete"))
