"""Streams of random numbers."""

import numpy as np
import pytest
from pydrake.symbolic import Expression, Variable
from scipy import stats

from drake_formation.systems.random_stream import next_normal, next_uniform, random_start

MULTIPLIERS, MODULI = (40014, 40692), (2147483563, 2147483399)


def drawn(count, draw, state):
    values = []
    for _ in range(count):
        value, state = draw(state)
        values.append(value)
    return np.array(values)


def draw_uniform(state):
    value, *state = next_uniform(*state)
    return value, state


def test_the_generator_is_the_exact_one_of_whole_numbers():
    state = random_start(3, "channel_1_to_2")
    exact = [int(number) for number in state]
    for _ in range(2000):
        value, *state = next_uniform(*state)
        exact = [a * x % m for a, x, m in zip(MULTIPLIERS, exact, MODULI, strict=True)]
        assert state == exact
        assert value == pytest.approx(((exact[0] - exact[1]) % (MODULI[0] - 1) + 0.5) / (MODULI[0] - 1), abs=1e-15)


def test_uniform_and_normal_numbers_are_distributed_as_they_say():
    uniform = drawn(20_000, draw_uniform, random_start(0, "a"))
    normal = drawn(20_000, next_normal, random_start(0, "b"))
    assert stats.kstest(uniform, "uniform").pvalue > 0.01
    assert stats.kstest(normal, "norm").pvalue > 0.01
    assert abs(np.corrcoef(uniform[:-1], uniform[1:])[0, 1]) < 0.02


def test_streams_are_named_and_know_nothing_of_each_other():
    assert np.array_equal(random_start(5, "robot_1/sensor"), random_start(5, "robot_1/sensor"))
    starts = {tuple(random_start(seed, path)) for seed in range(20) for path in ("a", "b", "ab", "ba")}
    assert len(starts) == 80
    first = drawn(5000, draw_uniform, random_start(0, "channel_1_to_2"))
    second = drawn(5000, draw_uniform, random_start(0, "channel_2_to_1"))
    assert abs(np.corrcoef(first, second)[0, 1]) < 0.05


def test_symbols_draw_the_same_numbers():
    variables = [Variable("a"), Variable("b")]
    value, (a, b) = next_normal([Expression(v) for v in variables])
    start = random_start(1, "x")
    at = dict(zip(variables, start, strict=True))
    expected, state = next_normal(start.tolist())
    assert [a.Evaluate(at), b.Evaluate(at)] == state
    assert value.Evaluate(at) == pytest.approx(expected, rel=1e-14)
