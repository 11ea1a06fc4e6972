import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tracking_loops import START, apart, path, two

from drake_formation import ScenarioError
from drake_formation.analysis import IllPosedError, certify

MASS = 40.0
distinct_poles = st.tuples(st.floats(0.3, 0.8), st.floats(1.0, 1.5), st.floats(1.8, 2.5))


def gains(poles):
    """Gains that give m s³ + k_d s² + k_p s + k_i the roots −p."""
    _, kd, kp, ki = MASS * np.poly(-np.array(poles))
    return {"kp": float(kp), "ki": float(ki), "kd": float(kd)}


def integral_of_error(poles, times, order):
    """The derivative of an order of z = ∫ e dt from z = 0, ż = 1, z̈ = 0: a sum of exponentials with these rates."""
    rates = -np.array(poles)
    weights = np.linalg.solve(np.vander(rates, increasing=True).T, [0.0, 1.0, 0.0])
    return (weights * rates**order * np.exp(np.outer(times, rates))).sum(axis=1)


@given(distinct_poles)
@settings(max_examples=5, deadline=None)
def test_the_robot_moves_by_the_poles_that_its_gains_give(poles):
    times, position = path(kind="pid", **gains(poles))
    expected = np.outer(integral_of_error(poles, times, 1), START)
    np.testing.assert_allclose(position, expected, rtol=0, atol=1e-6)


def test_without_an_integral_it_is_the_lqr_of_those_gains():
    pd = path(kind="pid", kp=1.0, ki=0.0, kd=9.0)
    lqr = path(kind="lqr")
    np.testing.assert_allclose(pd[1][-1], lqr[1][-1], rtol=0, atol=1e-7)


@pytest.mark.parametrize("engine", ["compiled", "exponential"])
def test_engines_agree(engine):
    assert apart(engine, kind="pid", kp=100.0, ki=40.0, kd=80.0) < 1e-4


def test_gains_that_are_unstable_are_refused_with_the_limit():
    with pytest.raises(ScenarioError, match=r"tracking.ki: unstable with a robot of 40 kg .*below .* = 0.225"):
        two(kind="pid", ki=0.225)
    two(kind="pid", ki=0.2249)


def test_the_analysis_refuses_it_by_name():
    with pytest.raises(IllPosedError, match="tracking 'pid' of drake-formation"):
        certify(two(kind="pid"))
