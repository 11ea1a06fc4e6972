"""A pair of eigenvalues followed as a gain rises: what it is at every gain, and where it ends."""

from itertools import islice, takewhile

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drake_formation.analysis.gains.eigenvalue_pairs import course, pairs_of


def second_order(stiffness, damping):
    """ẋ = A x of q̈ + D q̇ + K q = 0."""
    size = len(stiffness)
    return np.block([[np.zeros((size, size)), np.eye(size)], [-stiffness, -damping]])


@given(frequency=st.floats(0.5, 5.0), other=st.floats(0.5, 5.0), angle=st.floats(0.0, 1.5), rates=st.floats(0.2, 3.0))
@settings(max_examples=40)
def test_modes_that_do_not_mix_pass_through_one_another(frequency, other, angle, rates):
    """Proportional damping: each has its own quadratic, whatever the coordinates and whatever the others do."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    stiffness = turn @ np.diag([frequency**2, (other + 5) ** 2]) @ turn.T
    growth = turn @ np.diag([1.0, rates]) @ turn.T

    def loop(gain):
        return second_order(stiffness, gain * growth)

    (first,) = pairs_of(loop, turn[:, :1])
    passed = [first, *takewhile(lambda pair: pair.gain < 10 * frequency, course(first, loop, 0.01 * frequency))]
    assert passed[-1].gain > frequency
    for pair in passed:
        assert pair.damping_ratio == pytest.approx(pair.gain / (2 * frequency), rel=1e-5, abs=1e-9)


def test_two_real_eigenvalues_of_different_pairs_that_meet_end_the_course():
    """(s² + 5 s + 4)(s² + (13 − g) s + …): 4 rises, 9 falls, and at g = 5/3 they meet at 17/3."""

    def loop(gain):
        roots = np.array([1.0, 4.0 + gain, 9.0 - 2 * gain, 20.0])
        a, b = roots[1:3].sum() / 2, roots[1] * roots[2]
        quartic = np.polymul(np.poly([-1.0, -20.0]), [1.0, 2 * a, b + 0.05 * max(gain - 1.2, 0.0)])
        companion = np.diag(np.ones(3), 1)
        companion[-1] = -quartic[:0:-1]
        return companion

    start = pairs_of(loop, np.eye(2)[:, :1])[0]
    passed = list(islice(course(start, loop, 0.01), 10000))
    assert 1.2 < passed[-1].gain < 5 / 3
