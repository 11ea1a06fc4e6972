from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from strategies import generators

from drake_formation.formation.obstacles import Obstacles
from drake_formation.parts.references.minimum_jerk import minimum_jerk
from drake_formation.parts.references.planner import (
    PIECES,
    PotentialField,
    StuckError,
    clearances,
    closest,
    plan,
    plan_trajectory,
)

CLEARANCE, REACH = 0.5, 1.5
START, GOAL = np.array([0.0, 0.0]), np.array([20.0, 0.0])
HEAD_ON = [[10.0, 0.0, 1.0]]
WALL = [[10.0, 1.2, 1.0], [10.0, -1.2, 1.0]]
few = settings(max_examples=30)


def field(discs, goal=GOAL):
    return PotentialField(np.array(goal), Obstacles.circles(discs), CLEARANCE, REACH)


def sampled(trajectory):
    return trajectory.vector_values(np.linspace(0, trajectory.end_time(), 2000)).T


def random_field(rng):
    """Up to three discs anywhere about the way; two of them may overlap with their reaches, or block it."""
    centres = np.column_stack([rng.uniform(3, 17, 3), rng.uniform(-2, 2, 3)])
    return field(np.column_stack([centres, rng.uniform(0.2, 1.5, 3)])[: rng.integers(1, 4)])


def potential(points, world):
    """‖p − goal‖ + Σ ½ η (1/ρ − 1/ρ0)², infinite inside a disc; written down once more."""
    away = clearances(points, world.obstacles)
    with np.errstate(divide="ignore"):
        near = np.maximum(1 / np.maximum(away, 0.0) - 1 / world.reaches(), 0.0)
    return np.linalg.norm(points - world.goal, axis=-1) + (0.5 * world.gains() * near**2).sum(axis=-1)


def in_a_hollow(place, world, radius=0.6 * CLEARANCE):
    """Whether the potential within a circle about a place is lower than anywhere on it: a local minimum."""
    angles, shares = np.linspace(0, 2 * np.pi, 721), np.linspace(0, 0.95, 60)
    around = np.column_stack([np.cos(angles), np.sin(angles)])
    within = (place + radius * shares[:, None, None] * around).reshape(-1, 2)
    return potential(within, world).min() < potential(place + radius * around, world).min()


def planned(world):
    """The plan, or None where it is stuck, which must be in a hollow."""
    try:
        return plan(START, world)
    except StuckError as error:
        place = error.place
    assert in_a_hollow(place, world)
    return None


@few
@given(generators)
def test_a_plan_reaches_the_goal_clear_of_every_disc_or_is_stuck_in_a_hollow(rng):
    world = random_field(rng)
    path = planned(world)
    if path is None:
        return
    np.testing.assert_array_equal(path[[0, -1]], [START, GOAL])
    assert clearances(path, world.obstacles).min() > 0


@few
@given(generators)
def test_past_one_disc_a_plan_keeps_the_clearance(rng):
    world = field([[rng.uniform(4, 16), rng.uniform(-3, 3), rng.uniform(0.1, 2)]])
    path = plan(START, world)
    assert clearances(path, world.obstacles).min() > 0.94 * CLEARANCE  # a step may lead a little too far
    assert clearances(sampled(plan_trajectory(path, world, 60.0)), world.obstacles).min() > 0.75 * CLEARANCE


@few
@given(generators)
def test_a_plan_flows_downhill(rng):
    """No disc in reach, the way is straight; so it turns only where it is pushed."""
    world = random_field(rng)
    path = planned(world)
    if path is None:
        return
    free = (clearances(path, world.obstacles) >= world.reaches()).all(axis=1)
    to_goal = GOAL - path
    for k in np.flatnonzero(free[1:-1]) + 1:
        step = path[k + 1] - path[k]
        assert step @ to_goal[k] == pytest.approx(np.linalg.norm(step) * np.linalg.norm(to_goal[k]), rel=1e-9)


def test_most_fields_have_a_plan():
    """What the laws above let pass is the exception."""
    stuck = 0
    for seed in range(60):
        try:
            plan(START, random_field(np.random.default_rng(seed)))
        except StuckError:
            stuck += 1
    assert stuck <= 15


@few
@given(generators)
def test_a_polygonal_lines_closest_point_is_that_of_its_densest_samples(rng):
    path, obstacles = rng.uniform(-5, 5, (6, 2)), Obstacles.circles(rng.uniform(0.1, 5, (4, 3)))
    dense = np.vstack([np.linspace(a, b, 2000) for a, b in pairwise(path)])
    np.testing.assert_allclose(closest(path, obstacles), clearances(dense, obstacles).min(axis=0), atol=5e-3)


def test_head_on_a_plan_goes_around_to_the_left():
    path = plan(START, field(HEAD_ON))
    assert path[:, 1].max() > 1 + 0.9 * CLEARANCE
    assert path[:, 1].min() > -0.1


def test_between_two_discs_too_near_to_each_other_a_plan_is_stuck_before_them():
    with pytest.raises(StuckError) as error:
        plan(START, field(WALL))
    assert 5 < error.value.place[0] < 10


def test_a_disc_near_the_goal_does_not_push_the_plan_away_from_it():
    near = field([[18.9, 0.0, 0.2]])
    np.testing.assert_allclose(near.reaches(), 0.9)
    np.testing.assert_array_equal(plan(START, near)[-1], GOAL)


@few
@given(generators)
def test_repulsion_balances_attraction_at_the_clearance(rng):
    world = random_field(rng)
    slope = 1 / CLEARANCE - 1 / world.reaches()
    np.testing.assert_allclose(world.gains() * slope / CLEARANCE**2, 1)


def test_without_obstacles_a_plan_is_the_minimum_jerk_line():
    straight, line = plan_trajectory(plan(START, field([])), field([]), 60.0), minimum_jerk(START, GOAL, 60.0)
    np.testing.assert_allclose(sampled(straight), sampled(line), atol=1e-9)


@pytest.mark.parametrize("discs", [HEAD_ON, [], [[6.0, 1.5, 0.7], [14.0, -1.5, 0.7]]])
def test_every_plan_has_as_many_pieces_and_ends_at_the_goal(discs):
    trajectory = plan_trajectory(plan(START, field(discs)), field(discs), 60.0)
    assert trajectory.get_number_of_segments() == PIECES
    np.testing.assert_allclose(trajectory.value(0.0).ravel(), START, atol=1e-9)
    np.testing.assert_allclose(trajectory.value(60.0).ravel(), GOAL, atol=1e-9)


@pytest.mark.parametrize("angle", [0.3, 1.7, -2.2])
def test_a_plan_turns_with_the_world_frame(angle):
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    discs = np.array([[6.0, 1.5, 0.7], [14.0, -1.5, 0.7]])
    turned = np.column_stack([discs[:, :2] @ turn.T, discs[:, 2]])
    expected = sampled(plan_trajectory(plan(START, field(discs)), field(discs), 60.0)) @ turn.T
    world = field(turned, turn @ GOAL)
    np.testing.assert_allclose(sampled(plan_trajectory(plan(START, world), world, 60.0)), expected, atol=1e-6)
