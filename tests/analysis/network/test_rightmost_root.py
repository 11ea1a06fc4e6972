"""The rightmost root of systems with several delays: at known ends, by an independent package, and by laws."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import generators

from drake_formation.analysis import stable_delays
from drake_formation.analysis.linear.errors import IllPosedError
from drake_formation.analysis.network.rightmost_root import rightmost_root


@given(rng=generators, delays=st.lists(st.floats(0.0, 3.0), min_size=1, max_size=3))
@settings(max_examples=30)
def test_it_solves_the_characteristic_equation(rng, delays):
    present, *delayed = rng.normal(size=(1 + len(delays), 3, 3))
    root = rightmost_root(present, list(zip(delayed, delays, strict=True)))
    equation = root * np.eye(3) - present - sum(m * np.exp(-root * t) for m, t in zip(delayed, delays, strict=True))
    assert np.linalg.svd(equation, compute_uv=False)[-1] < 1e-5


@pytest.mark.parametrize("seed", range(3))
def test_tdcpy_finds_the_same(seed):
    tdcpy = pytest.importorskip("tdcpy", reason="an independent package for time-delay systems")
    rng = np.random.default_rng(seed)
    present, *delayed = rng.normal(size=(3, 3, 3)) - [np.eye(3), np.zeros((3, 3)), np.zeros((3, 3))]
    delays = rng.uniform(0.1, 2.0, 2).tolist()
    roots, _ = tdcpy.roots(tdcpy.RDDE([present, *delayed], [0.0, *delays]), r=-2.0)
    assert rightmost_root(present, list(zip(delayed, delays, strict=True))).real == pytest.approx(roots.real.max())


@given(rng=generators)
@settings(max_examples=25)
def test_it_is_on_the_axis_where_an_interval_of_stable_delays_ends(rng):
    present, delayed = rng.normal(size=(2, 3, 3)) - [np.eye(3), np.zeros((3, 3))]
    for interval in stable_delays(present, delayed, up_to=10.0):
        for end in interval:
            if 0 < end < 10:
                assert abs(rightmost_root(present, [(delayed, end)]).real) < 1e-6


def test_without_delay_it_is_an_eigenvalue():
    matrix = np.array([[0.0, 1.0], [-4.0, -2.0]])
    assert rightmost_root(matrix, []) == pytest.approx(-1 + 1j * np.sqrt(3))
    assert rightmost_root(np.zeros((2, 2)), [(matrix, 0.0)]) == pytest.approx(-1 + 1j * np.sqrt(3))


def test_too_large_a_problem_is_refused():
    with pytest.raises(IllPosedError, match="too many"):
        rightmost_root(-1e3 * np.eye(300), [(np.eye(300), 1.0)])
