"""Plans within limits and clear of obstacles: half-planes, the quadratic program, and where there is no plan."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import generators

from drake_formation.parts.coordination import planning
from drake_formation.parts.coordination.half_planes import normals
from drake_formation.parts.coordination.linear_formation import formation_matrices
from drake_formation.parts.coordination.planning import Constraints, InfeasibleError, best_plan, constraints
from drake_formation.parts.coordination.prediction import prediction, sampled

HORIZON, PERIOD = 6, 0.5
AT_GOAL = np.zeros((2, 2)), np.zeros(4)
"""Slots and reference of two robots that both belong at the origin."""


@pytest.fixture(scope="module")
def two_robots():
    model = sampled(*formation_matrices(np.array([2.0, 3.0])), np.eye(8), 0.1 * np.eye(4), PERIOD)
    return prediction(model.pack().tobytes(), 2, HORIZON)


def about(foreseen, errors, limits, obstacles, distance, guess=None):
    now = errors.reshape(2, 4)[:, :2]
    path = foreseen.paths(*AT_GOAL, PERIOD, errors)
    guess = np.zeros(4 * HORIZON) if guess is None else guess
    return constraints(foreseen, now, path, guess, np.array(limits), np.reshape(obstacles, (-1, 3)), np.array(distance))


def cost(foreseen, errors, plan):
    return 0.5 * plan @ foreseen.hessian @ plan + foreseen.slope @ errors @ plan


@given(generators)
@settings(max_examples=20)
def test_a_half_plane_leaves_the_obstacle_out(rng):
    path, obstacles = np.cumsum(rng.uniform(-1, 1, (6, 2, 2)), axis=0), rng.uniform(-1, 1, (3, 3))
    obstacles[:, 2] = np.abs(obstacles[:, 2])
    outward = normals(path, obstacles, np.array([0.1, 0.2]))
    assert outward.shape == (5, 2, 3, 2)
    np.testing.assert_allclose(np.linalg.norm(outward, axis=-1), 1.0)


def test_a_path_around_is_believed_and_one_through_is_not():
    around = [[-2, 0], [-1, 1], [0, 1.5], [1, 1], [2, 0]]
    through = [[-2, 0], [-1.5, 0], [0.1, 0], [1.5, 0], [2, 0]]
    leapt = [[-2, 0], [-1.5, 0], [1.5, 0], [2, 0], [3, 0]]
    path = np.array([around, through, leapt], dtype=float).transpose(1, 0, 2)
    outward = normals(path, np.array([[0.0, 0.0, 0.5]]), np.full(3, 0.5))[:, :, 0]
    expected = np.array(around[1:]) / np.linalg.norm(around[1:], axis=1)[:, None]
    np.testing.assert_allclose(outward[:, 0], expected)
    np.testing.assert_allclose(outward[:, 1], [[-1, 0]] * 4)
    np.testing.assert_allclose(outward[:, 2], [[-1, 0]] * 4)


@given(limit=st.floats(0.1, 5.0), rng=generators)
@settings(max_examples=15)
def test_within_limits_no_plan_costs_less(two_robots, limit, rng):
    errors = rng.uniform(-3, 3, 8)
    plan = best_plan(two_robots, errors, about(two_robots, errors, [limit, 2 * limit], [], [-np.inf, -np.inf]))
    limits = np.tile([limit, limit, 2 * limit, 2 * limit], HORIZON)
    assert (np.abs(plan) <= limits * (1 + 1e-6)).all()
    # A step down the slope, cut to the limits, leads nowhere: the condition for the least of a convex function.
    slope = two_robots.hessian @ plan + two_robots.slope @ errors
    step = np.clip(plan - slope / np.linalg.norm(two_robots.hessian, 2), -limits, limits)
    np.testing.assert_allclose(step, plan, atol=1e-4)


@given(rng=generators)
@settings(max_examples=15)
def test_a_plan_keeps_its_distance_and_is_the_best_where_it_need_not(two_robots, rng):
    """One obstacle between the robots and their goal; unlimited forces always find a way."""
    errors = np.concatenate([[-3, rng.uniform(0.1, 1), 0, 0], [3, rng.uniform(0.1, 1), 0, 0]])
    obstacles, distance = [[0.0, -0.3, 0.2], [40.0, 40.0, 1.0]], [0.1, 0.3]
    kept = about(two_robots, errors, [np.inf] * 2, obstacles, distance)
    plan = best_plan(two_robots, errors, kept)
    path = two_robots.paths(*AT_GOAL, PERIOD, errors) + two_robots.shifts @ plan
    apart = np.linalg.norm(path - [0.0, -0.3], axis=-1)
    assert (apart >= np.array([0.3, 0.5]) - 1e-5).all()
    free = two_robots.best @ errors
    assert cost(two_robots, errors, plan) >= cost(two_robots, errors, free) - 1e-9
    if kept.kept_by(free):
        np.testing.assert_array_equal(plan, free)


def test_a_little_too_near_is_led_out_again(two_robots):
    errors = np.array([-0.4995, 0, 0, 0, 3.0, 0, 0, 0])
    kept = about(two_robots, errors, [1e-3, 10.0], [[0.0, 0.0, 0.2]], [0.3, 0.3])
    plan = best_plan(two_robots, errors, kept)
    path = two_robots.paths(*AT_GOAL, PERIOD, errors) + two_robots.shifts @ plan
    assert (np.linalg.norm(path[:, 0], axis=-1) >= 0.4995 - 1e-6).all()


def test_the_robot_that_cannot_is_named_with_the_obstacle_and_what_is_missing(two_robots):
    errors = np.array([3.0, 0, 0, 0, -1.0, 0, 4.0, 0])  # the second one races towards an obstacle
    kept = about(two_robots, errors, [1.0, 1.0], [[0.0, 9.0, 0.5], [0.0, 0.0, 0.2]], [0.1, 0.1])
    with pytest.raises(InfeasibleError) as failure:
        best_plan(two_robots, errors, kept)
    assert (failure.value.robot, failure.value.obstacle) == (1, 1)
    # Decelerating with 1 N at 3 kg for 3 s it comes to −1 + 12 − 1.5 m, and the half-plane ends at −0.3 m.
    assert failure.value.missing == pytest.approx(9.8, rel=1e-3)
    assert "robot 2 is 9.8 m short of its distance to obstacle 2" in str(failure.value)


def test_without_limits_and_obstacles_nothing_is_asked(two_robots):
    empty = Constraints(np.full(4 * HORIZON, np.inf), np.zeros((HORIZON, 2, 0, 4 * HORIZON)), np.zeros((HORIZON, 2, 0)))
    assert empty.kept_by(np.full(4 * HORIZON, 1e9))


def test_a_solver_that_gives_up_is_told_of(two_robots, monkeypatch):
    monkeypatch.setattr(planning, "_solved", lambda *_: None)
    errors = np.array([3.0, 0, 0, 0, -1.0, 0, 4.0, 0])
    with pytest.raises(RuntimeError, match="OSQP finds no plan within force limits"):
        best_plan(two_robots, errors, about(two_robots, errors, [0.1, 0.1], [], [0.1, 0.1]))


def test_the_same_problem_has_the_same_plan(two_robots):
    errors = np.array([-3, 0.2, 0, 0, 3, 0.4, 0, 0])
    kept = about(two_robots, errors, [2.0, 2.0], [[0.0, -0.3, 0.2]], [0.1, 0.3])
    np.testing.assert_array_equal(best_plan(two_robots, errors, kept), best_plan(two_robots, errors, kept))
