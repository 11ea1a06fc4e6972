"""The mean-square gain against the whole E[Φ ⊗ Φ], summed over every pattern of losses."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import scenarios

from drake_formation import load_scenario
from drake_formation.analysis import linearize
from drake_formation.analysis.network import mean_square
from drake_formation.analysis.network.mean_square import mean_square_gain
from drake_formation.analysis.network.sampled_data import sampled_loop


def second_moment(loop, arrival):
    """E[Φ ⊗ Φ], pattern by pattern."""
    result = 0.0
    for pattern in product([0, 1], repeat=len(loop.place)):
        step = loop.base + sum(loop.into[loop.place[c]] @ loop.out[c] for c in np.flatnonzero(pattern))
        arrived = sum(pattern)
        result = result + arrival**arrived * (1 - arrival) ** (len(pattern) - arrived) * np.kron(step, step)
    return result


def radius(matrix):
    return np.abs(np.linalg.eigvals(matrix)).max()


@given(
    scenario=scenarios(robots=st.integers(2, 3)),
    arrival=st.floats(0.01, 0.99),
    seconds=st.floats(0.01, 0.5),
    lost=st.just("zero") | st.just("hold"),
)
@settings(max_examples=30)
def test_the_gain_is_below_one_exactly_where_the_second_moment_decays(scenario, arrival, seconds, lost):
    formation = linearize(scenario)
    if lost == "hold" and formation.robots > 2:
        return
    loop = sampled_loop(formation, seconds, lost)
    exact, gain = radius(second_moment(loop, arrival)), mean_square_gain(loop, arrival)
    if abs(exact - 1) > 1e-9:
        assert (gain < 1) == (exact < 1)


@given(scenario=scenarios(robots=st.just(2)), arrival=st.floats(0.05, 0.95), seconds=st.floats(0.01, 0.5))
@settings(max_examples=15)
def test_at_a_gain_of_one_the_second_moment_has_the_eigenvalue_one(scenario, arrival, seconds):
    """Loss noise of another variance: with q (1 − q) over the gain in its place the radius is exactly 1."""
    loop = sampled_loop(linearize(scenario), seconds)
    gain = mean_square_gain(loop, arrival)
    if not 0 < gain < np.inf:
        return
    mean = loop.mean(arrival)
    noise = sum(
        np.kron(step, step) for step in (loop.into[p] @ out for p, out in zip(loop.place, loop.out, strict=True))
    )
    moment = np.kron(mean, mean) + arrival * (1 - arrival) / gain * noise
    assert np.abs(np.linalg.eigvals(moment) - 1).min() < 1e-6
    assert radius(moment) == pytest.approx(1.0, abs=1e-6)


def test_the_whole_map_and_arnoldis_method_agree(monkeypatch):
    overrides = {"consensus.delta": 1e4, "consensus.delta_v": 300.0, "springs.stiffness": 3e4}
    loop = sampled_loop(linearize(load_scenario("octagon", overrides=overrides)), 0.02)
    whole = [mean_square_gain(loop, arrival) for arrival in (0.1, 0.5, 0.9)]
    monkeypatch.setattr(mean_square, "DENSE", 0)
    assert [mean_square_gain(loop, arrival) for arrival in (0.1, 0.5, 0.9)] == pytest.approx(whole, rel=1e-9)


def test_certainty_makes_no_noise_and_an_unstable_mean_has_no_finite_gain():
    formation = linearize(load_scenario("line", overrides={"consensus.delta": 1e4}))
    assert mean_square_gain(sampled_loop(formation, 5e-4), 1.0) == 0.0
    assert mean_square_gain(sampled_loop(formation, 5e-4), 0.0) == 0.0
    assert mean_square_gain(sampled_loop(formation, 2e-3), 1.0) == np.inf
