import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drake_formation.parts.robots.wheels import (
    body_wrench,
    what_is_lacking,
    wheel_forces,
    wheel_jacobian,
    within_limit,
)

TRIANGLE = np.radians([0.0, 120.0, 240.0])
CORNERS = np.radians([45.0, 135.0, 225.0, 315.0])
MECANUM = np.radians([-45.0, 45.0, -45.0, 45.0])
angles = st.floats(-np.pi, np.pi)


def tangential(mounting):
    return np.asarray(mounting) + np.pi / 2


def test_the_jacobian_of_three_omni_wheels_is_the_textbooks():
    root = np.sqrt(3) / 2
    expected = [[0, -root, root], [1, -0.5, -0.5], [0.3, 0.3, 0.3]]
    np.testing.assert_allclose(wheel_jacobian(TRIANGLE, tangential(TRIANGLE), 0.3), expected, atol=1e-15)


def test_mecanum_wheels_push_forward_sideways_and_turn_by_their_signs():
    # Front left, rear left, rear right, front right.
    signs = np.sign(wheel_jacobian(CORNERS, MECANUM, 0.3))
    np.testing.assert_array_equal(signs, [[1, 1, 1, 1], [-1, 1, -1, 1], [-1, -1, 1, 1]])


@given(angles, angles, st.tuples(*[st.floats(-2, 2)] * 3))
def test_the_jacobian_is_dual_to_the_wheels_speeds(beta, alpha, motion):
    vx, vy, turning = motion
    x, y = 0.3 * np.cos(beta), 0.3 * np.sin(beta)
    speed = (vx - turning * y) * np.cos(alpha) + (vy + turning * x) * np.sin(alpha)
    np.testing.assert_allclose(wheel_jacobian([beta], [alpha], 0.3).T @ motion, [speed], atol=1e-12)


@pytest.mark.parametrize(("mounting", "push"), [(TRIANGLE, tangential(TRIANGLE)), (CORNERS, MECANUM)])
@given(wrench=st.tuples(*[st.floats(-1e3, 1e3)] * 3))
def test_wheels_exert_the_wrench_that_is_asked_for(mounting, push, wrench):
    jacobian = wheel_jacobian(mounting, push, 0.3)
    forces = wheel_forces(wrench, np.linalg.pinv(jacobian).ravel().tolist())
    np.testing.assert_allclose(body_wrench(forces, jacobian.ravel().tolist()), wrench, atol=1e-10)
    assert forces == pytest.approx(np.linalg.lstsq(jacobian, wrench)[0], abs=1e-9)  # the smallest such forces


@given(st.lists(angles, min_size=3, max_size=4), st.floats(-np.pi, np.pi))
def test_turning_all_wheels_changes_nothing_they_can_do(mounting, turn):
    before = np.linalg.svd(wheel_jacobian(mounting, tangential(mounting), 1.0))[1]
    turned = np.add(mounting, turn)
    np.testing.assert_allclose(np.linalg.svd(wheel_jacobian(turned, tangential(turned), 1.0))[1], before, atol=1e-12)


@pytest.mark.parametrize(
    ("mounting", "push", "lacking"),
    [
        (TRIANGLE, tangential(TRIANGLE), ""),
        (CORNERS, MECANUM, ""),
        (CORNERS, np.zeros(4), "rank 2, not 3: they cannot push along 90 deg"),
        (CORNERS, CORNERS, "rank 2, not 3: they cannot turn it"),
        ([0.0, 0.0, 2.0], tangential([0.0, 0.0, 2.0]), "rank 2, not 3: they cannot push without turning it"),
        ([1.0, 1.0, 1.0], tangential([1.0, 1.0, 1.0]), "rank 1, not 3: all wheels do the same"),
    ],
)
def test_what_a_layout_cannot_do_is_said(mounting, push, lacking):
    assert what_is_lacking(mounting, push).endswith(lacking)
    assert bool(what_is_lacking(mounting, push)) == bool(lacking)


@given(st.floats(-1e3, 1e3), st.floats(0.1, 100.0))
def test_a_limited_force_is_the_nearest_within(force, limit):
    assert within_limit(force, limit) == np.clip(force, -limit, limit)
