"""The sampled loop: a period is what the diagram's blocks do in one, and the longest stable one is where it turns."""

from itertools import pairwise

import numpy as np
import pytest
from channels import OpenChannels
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag, expm
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.network.delay_margin import delay_margin
from drake_formation.analysis.network.sampled_data import (
    channels,
    longest_period,
    period,
    sampled_loop,
    stable_periods,
)

several = st.integers(2, 4)


@given(scenario=scenarios(robots=several), seconds=st.floats(1e-4, 1.0))
@settings(max_examples=15)
def test_a_period_is_the_exact_solution_under_a_constant_acceleration(scenario, seconds):
    formation = linearize(scenario)
    A, constant = formation.A, np.random.default_rng(0).normal(size=len(formation.A))
    flow, held = period(A, seconds)
    np.testing.assert_allclose(flow, expm(A * seconds), rtol=1e-8, atol=1e-10)
    # x' = A x + c from rest: A x(T) = (e^{AT} − I) c.
    np.testing.assert_allclose(A @ held @ constant, (flow - np.eye(len(A))) @ constant, atol=1e-6 * np.abs(A).max())


@given(scenario=scenarios(robots=several), seconds=st.floats(1e-3, 0.3))
@settings(max_examples=15)
def test_without_loss_both_kinds_are_the_loop_sampled_as_a_whole(scenario, seconds):
    formation = linearize(scenario)
    flow, held = period(formation.tracking + formation.springs, seconds)
    whole = flow + held @ formation.consensus(formation.delta, formation.delta_v)
    np.testing.assert_allclose(sampled_loop(formation, seconds).mean(1.0), whole, atol=1e-9 * np.abs(whole).max())
    memory = 2 * len(channels(formation)[0])
    longer = sampled_loop(formation, seconds, "hold").mean(1.0)
    expected = np.poly(block_diag(whole, np.zeros((memory, memory))))
    np.testing.assert_allclose(np.poly(longer), expected, atol=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("lost", ["zero", "hold"])
def test_periods_with_losses_are_what_the_diagrams_blocks_do(lost):
    overrides = {
        "consensus": {"delta": 500.0, "delta_v": 80.0, "graph": "path"},
        "springs.stiffness": 100.0,
        "robots.mass": [20.0, 30.0, 40.0, 50.0],
    }
    formation = linearize(load_scenario("quadrilateral", overrides=overrides))
    robots, rng, seconds = OpenChannels(formation.scenario), np.random.default_rng(2), 0.05
    np.testing.assert_array_equal([robots.to, robots.of], channels(formation))
    loop = sampled_loop(formation, seconds, lost)
    state = 1e-6 * rng.normal(size=16)
    heard = (1e-6 * rng.normal(size=16) + robots.rest).reshape(-1, 4)[robots.of]
    whole = np.concatenate([state, remembered(formation, robots, heard)]) if lost == "hold" else state
    for _ in range(6):
        arrives = rng.random(len(robots.to)) < 0.5
        step = loop.base + sum(loop.into[loop.place[c]] @ loop.out[c] for c in np.flatnonzero(arrives))
        whole = step @ whole
        state, heard = robots.held_period(robots.rest + state, heard, arrives, lost, seconds)
        state = state - robots.rest
        np.testing.assert_allclose(state, whole[:16], atol=1e-4 * np.abs(state).max())


def remembered(formation, robots, heard):
    """The memories (m/s²) that what was heard last, shape (channels, 4), stands for."""
    masses = np.array(formation.scenario.robots.mass)[robots.to][:, None]
    deviation = heard - robots.rest.reshape(-1, 4)[robots.of]
    delta, delta_v = formation.delta, formation.delta_v
    return ((delta * deviation[:, :2] + delta_v * deviation[:, 2:]) / masses).ravel()


@given(scenario=scenarios(robots=several))
@settings(max_examples=15)
def test_the_longest_period_is_where_the_spectral_radius_reaches_one(scenario):
    formation = linearize(scenario)
    longest = longest_period(formation)

    def radius(seconds):
        return np.abs(np.linalg.eigvals(sampled_loop(formation, seconds).mean(1.0))).max()

    assert max(radius(seconds) for seconds in np.linspace(0.02, 0.999, 25) * (longest or 1.0)) < 1
    if longest is not None:
        assert radius(longest) == pytest.approx(1.0, abs=1e-8)
        assert radius(1.001 * longest) > 1


@pytest.mark.parametrize(("name", "robots"), [("line", 2), ("quadrilateral", 4), ("octagon", 8)])
@pytest.mark.parametrize("stiffness", [1.45, 3e4])
def test_undamped_virtual_springs_tolerate_half_a_period_as_delay(name, robots, stiffness):
    formation = linearize(load_scenario(name, overrides={"consensus.delta": 1e4, "springs.stiffness": stiffness}))
    assert longest_period(formation) == pytest.approx(2 * 9 / (robots * 1e4), rel=1e-3)
    assert longest_period(formation) == pytest.approx(2 * delay_margin(formation, of="relative").delay_s, rel=1e-3)


def test_weak_consensus_may_be_sampled_slowly():
    formation = linearize(load_scenario("line", overrides={"consensus.delta": 0.2}))
    assert longest_period(formation) is None
    assert longest_period(formation, up_to_s=5.0) is None


def test_a_narrow_range_of_unstable_periods_is_not_stepped_over():
    """Between 0.762 and 0.807 s the held force meets a mode of the springs; longer periods are stable again."""
    overrides = {
        "formation.heading": 0.0,
        "robots.mass": [74.72012779614913, 46.18760587512777],
        "springs.stiffness": 368.47704031838504,
        "springs.damping": 19.71173030025674,
        "tracking.Q": [
            [2.499627356889265, 0.9642580024451317, -1.0022572359159398, -0.4168557151481794],
            [0.9642580024451317, 1.3038501651223242, -0.6674957287581739, -0.6393024394002094],
            [-1.0022572359159398, -0.6674957287581739, 1.1896735973319537, 0.6439732685300862],
            [-0.4168557151481794, -0.6393024394002094, 0.6439732685300862, 1.828058968574038],
        ],
        "tracking.R": [[1.1332170424250028, 0.6715170538266831], [0.6715170538266831, 1.227500969661334]],
        "consensus.delta": 23.477267505879862,
        "consensus.delta_v": 32.89953503879047,
    }
    assert longest_period(linearize(load_scenario("line", overrides=overrides))) == pytest.approx(0.7619, abs=1e-4)


def test_the_known_sampling_limit_of_held_state_feedback():
    present, gains = np.array([[0.0, 1.0], [0.0, -0.1]]), np.array([[3.75, 11.5]])
    (stable,) = stable_periods(present, -np.array([[0.0], [0.1]]) @ gains, up_to=10.0)
    assert stable == pytest.approx((0.0, 1.729414), abs=5e-7)


@given(rate=st.floats(0.01, 100.0), share=st.floats(0.01, 0.9) | st.floats(-0.99, -0.01))
def test_the_sampling_limit_of_one_state(rate, share):
    """ẋ = a x − b x(kT): e^{aT} (1 − b/a) + b/a = −1, T = ln((b + a)/(b − a))/a."""
    decay = share * rate
    limit = np.log((rate + decay) / (rate - decay)) / decay
    (stable,) = stable_periods(decay, -rate, up_to=2 * limit)
    assert stable == pytest.approx((0.0, limit), rel=1e-9)


def test_held_feedback_calms_an_oscillator_but_about_whole_turns():
    """ẍ = 0.02 ẋ − x + 0.2 x(kT), which held for a whole turn or half of one does next to nothing."""
    present, sampled = np.array([[0.0, 1.0], [-1.0, 0.02]]), np.array([[0.0, 0.0], [0.2, 0.0]])

    def radius(seconds):
        flow = expm(seconds * present)
        return np.abs(np.linalg.eigvals(flow + np.linalg.solve(present, flow - np.eye(2)) @ sampled)).max()

    stable = stable_periods(present, sampled, up_to=12.0)
    assert len(stable) >= 3
    ends = np.array(stable).ravel()
    np.testing.assert_allclose([radius(end) for end in ends[(ends > 0) & (ends < 12)]], 1.0, atol=1e-9)
    assert all(radius((low + high) / 2) < 1 for low, high in stable)
    assert all(radius((before.high + after.low) / 2) > 1 for before, after in pairwise(stable))
