"""Intervals in which a function is negative, also where only a peak or a dip between points shows them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.analysis.network.intervals import Interval, common, where_negative

POINTS = np.linspace(0.0, 3.0, 10)


@given(ends=st.lists(st.floats(0.05, 2.95), min_size=1, max_size=3, unique=True))
def test_intervals_end_at_the_zeros(ends):
    ends = sorted(ends)
    if np.diff([0.0, *ends, 3.0]).min() < 0.02:
        return

    def sawtooth(x):
        return float(-np.prod(np.subtract(ends, x)))

    expected = [*zip([0.0, *ends[1::2]], [*ends[::2], 3.0], strict=False)]
    np.testing.assert_allclose(list(where_negative(sawtooth, np.linspace(0.0, 3.0, 200))), expected, atol=1e-9)


def test_what_only_a_peak_or_a_dip_between_points_shows():
    gap, narrow = list(where_negative(lambda x: 1e-4 - (x - 1.5) ** 2, POINTS)), 1e-2
    np.testing.assert_allclose(gap, [(0.0, 1.5 - narrow), (1.5 + narrow, 3.0)], atol=1e-9)
    inside = list(where_negative(lambda x: (x - 1.5) ** 2 - 1e-4, POINTS))
    np.testing.assert_allclose(inside, [(1.5 - narrow, 1.5 + narrow)], atol=1e-9)
    assert list(where_negative(lambda x: (x - 1.5) ** 2 + 1e-4, POINTS)) == []
    assert list(where_negative(lambda x: -1e-4 - (x - 1.5) ** 2, POINTS)) == [(0.0, 3.0)]


def test_the_first_interval_is_known_before_the_others_are_looked_for():
    asked = []

    def function(x):
        asked.append(x)
        return x - 1.0

    assert next(where_negative(function, POINTS)) == pytest.approx((0.0, 1.0))
    assert max(asked) < 1.5


def test_common_values_of_two_lists():
    one, other = [Interval(0, 1), Interval(2, 5)], [Interval(0.5, 3), Interval(4, np.inf)]
    assert common(one, other) == ((0.5, 1), (2, 3), (4, 5))
    assert common(one, []) == ()
